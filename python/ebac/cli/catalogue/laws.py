"""`ebac laws`: the laws and their parameters."""

from __future__ import annotations

import inspect
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
            help="A law to show in detail: its name, or FILE.py:NAME or MODULE:NAME for one of your own.",
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

    * `ebac laws my_law.py:Damped`: those of a law of your own

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

    if name is None:
        return [_row(design(law, device, timing)) for law in LAWS]
    found = by_name.laws([name], "NAME")
    if len(found) != 1:
        raise ValueError(f"NAME {name}: one law only; give one of {', '.join(found)}")
    ((called, law),) = found.items()
    return [_row(design(law, device, timing)) | {"law": called}]


def _row(law: Any) -> dict[str, Any]:
    from ebac.laws import law_name
    from ebac.laws.law_fields import fields_of

    docstring = (inspect.getdoc(type(law)) or "no docstring").partition("\n")[0].rstrip(".")
    return {
        "law": law_name(law),
        "what": getattr(law, "summary", docstring),
        "passive": getattr(law, "passive", False),
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
            for field in fields_of(law)
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
        bounded = parameter["low"] is not None and parameter["type"] != "bool"
        allowed = _range(parameter["low"], parameter["high"]) if bounded else ""
        unit = "" if parameter["unit"] in ("1", None) else parameter["unit"]
        grid.add_row(parameter["name"], designed, default, allowed, unit, parameter["meaning"])
    if row["parameters"]:
        output.show(grid)
    else:
        output.say(
            "It has no parameters that --change could set: those of a law in Python are the fields of a dataclass."
        )


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    return (
        f"{value:.4g}" if isinstance(value, (int, float)) else "" if value is None else str(value)
    )


def _range(low: float, high: float) -> str:
    return f"{low:g} to {high:g}"
