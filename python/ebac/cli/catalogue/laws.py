"""`ebac laws`: the laws and their parameters."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import by_name, completion, options, output, setting

if TYPE_CHECKING:
    from ebac._core import Device, Timing


def laws(
    name: Annotated[
        str | None,
        typer.Argument(
            help="Name of a law to show in detail.",
            show_default=False,
            autocompletion=completion.laws,
        ),
    ] = None,
    device: options.DeviceName = None,
    rate: options.Rate = None,
    delay: options.Delay = None,
    scenario: Annotated[
        Path | None,
        typer.Option(
            help="A scenario, or a configuration of `ebac run`, in TOML: its device, its rate and its delay are those "
            "that laws are designed for.",
            show_default=False,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """List the laws, or the parameters of one law.

    A law is designed from the device and the timing alone, never from the wall or the hand.

    **Examples**

    * `ebac laws`: every law

    * `ebac laws ebac --delay 2`: the parameters of EBAC, designed for 2 samples of delay

    * `ebac presets reference > device.toml`, then `ebac laws ebac --scenario device.toml`: those for your device
    """
    with output.refusing():
        whose, chosen, timing = _designed_for(device, scenario, rate, delay)
        rows = _rows(name, chosen, timing)
    if as_json:
        typer.echo(output.document("laws", rows))
    elif name is None:
        _show_all(rows)
    else:
        _show_one(rows[0])
        delayed = output.plural(timing.delay, "sample")
        output.say(
            f"designed: for {whose} at {1e-3 / timing.dt:.4g} kHz and {delayed} of delay; "
            "--device, --scenario, --rate and --delay choose others. default: of a law that is made without a device."
        )


def _designed_for(
    name: str | None, file: Path | None, rate: float | None, delay: int | None
) -> tuple[str, Device, Timing]:
    """Return the device in words, the device, and the timing that laws are designed for."""
    if name is not None and file is not None:
        raise ValueError(
            f"--device {name}: the device is that of --scenario {file}; give one of the two"
        )
    base = setting.device_base(file)
    timing = setting.choose_timing(base.known_timing, rate, delay)
    if file is not None:
        return f"the device of {file}", base.device, timing
    name = name or "reference"
    return f"the {name.lower()} device", setting.known_device(name), timing


def _rows(name: str | None, device: Device, timing: Timing) -> list[dict[str, Any]]:
    from ebac.laws import LAWS, design

    names = [by_name.one_law(name, "NAME")] if name is not None else list(LAWS)
    return [_row(design(law, device, timing)) for law in names]


def _row(law: Any) -> dict[str, Any]:
    return {
        "law": law.name,
        "what": law.summary,
        "passive": law.passive,
        "parameters": [
            {
                "name": field.name,
                "unit": field.unit,
                "meaning": field.meaning,
                "type": field.kind,
                "default": field.default,
                "low": field.low,
                "high": field.high,
                "designed": getattr(law, field.name),
            }
            for field in law.fields()
        ],
    }


def _show_all(rows: list[dict[str, Any]]) -> None:
    from ebac.laws.tuned_laws import tuned_laws

    grid = output.table(["law", "what", "passive", "parameters"])
    for row in rows:
        names = ", ".join(parameter["name"] for parameter in row["parameters"])
        grid.add_row(row["law"], row["what"], "yes" if row["passive"] else "no", names)
    output.show(grid)
    output.say(
        "passive: proven for every hand and every world that stands still, on one axis, given true damping, delay, "
        "lag and count, to within half a count times the force; on n axes the law needs sqrt(n) times the count."
    )
    output.say(f"Tuned: {', '.join(tuned_laws())}.")
    output.say(
        "LAW-tuned is LAW with the parameters that `ebac tune` found for the reference device at 1 kHz; "
        "LAW-tuned-observer the same acting on the observer's estimate."
    )
    output.say("`ebac laws NAME` shows one in detail.")


def _show_one(row: dict[str, Any]) -> None:
    passive = "passive by proof" if row["passive"] else "not proven passive"
    output.say(f"{row['law']}: {row['what']} ({passive})", style="bold")
    headings = ["parameter", "designed", "default", "range", "unit", "meaning"]
    grid = output.table(headings, numbers=(1, 2, 3))
    for parameter in row["parameters"]:
        designed, default = (_text(parameter[name]) for name in ("designed", "default"))
        allowed = "" if parameter["type"] == "bool" else _range(parameter["low"], parameter["high"])
        unit = "" if parameter["unit"] == "1" else parameter["unit"]
        grid.add_row(parameter["name"], designed, default, allowed, unit, parameter["meaning"])
    output.show(grid)


def _text(value: bool | float) -> str:
    return ("on" if value else "off") if isinstance(value, bool) else f"{value:.4g}"


def _range(low: float, high: float) -> str:
    return f"{low:g} to {high:g}"
