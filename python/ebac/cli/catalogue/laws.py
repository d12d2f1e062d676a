"""`ebac laws`: the laws and their parameters."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from ebac.cli import by_name, completion, options, output, setting


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
    as_json: output.AsJson = False,
) -> None:
    """List the laws, or the parameters of one law.

    A law is designed from the device and the timing alone, never from the wall or the hand.

    **Examples**

    * `ebac laws`: every law

    * `ebac laws ebac --delay 2`: the parameters of EBAC, designed for 2 samples of delay
    """
    with output.refusing():
        rows = _rows(name, device, rate, delay)
    if as_json:
        typer.echo(output.document("laws", rows))
    elif name is None:
        _show_all(rows)
    else:
        _show_one(rows[0])


def _rows(
    name: str | None, device: str | None, rate: float | None, delay: int | None
) -> list[dict[str, Any]]:
    from ebac._core import Timing
    from ebac.laws import LAWS, design

    names = [by_name.one_law(name, "NAME")] if name is not None else list(LAWS)
    chosen = setting.known_device(device or "reference")
    timing = setting.choose_timing(Timing(), rate, delay)
    return [_row(design(law, chosen, timing)) for law in names]


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
