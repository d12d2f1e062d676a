"""What `ebac identify arm` shows and writes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ebac.cli import output
from ebac.cli.by_option import columns_in_options
from ebac.cli.identify import report as reporting

if TYPE_CHECKING:
    from ebac.identify import ArmResult
    from ebac.identify.validation import Prediction


def careful(result: ArmResult) -> list[str]:
    """Return what to be careful about, a sentence each."""
    out = [f"{name} is not determined by this log." for name in result.undetermined]
    out += [
        f"{a} and {b} cannot be separated in this log (correlation {r:+.3f})."
        for a, b, r in result.inseparable
    ]
    out += result.misses
    return out


def names(result: ArmResult) -> list[str]:
    """Return what the names of a table mean where that does not show, a sentence each."""
    shown = [e.name for e in result.shown]
    levels = list(dict.fromkeys(n.split("@")[0] for n in shown if n.startswith("X0/")))
    out = []
    if levels:
        out.append(
            f"{', '.join(levels)}: where the hand wants to be, a position for each level of its target, in order; "
            "tapping has two, for the first and the second half of each period."
        )
    if any("@" in name for name in shown):
        out.append("NAME@2: of the second log; without @, of all logs.")
    return out


def _fit(p: Prediction) -> str:
    """Return how well the hand predicts a recording; below no model at all the numbers say nothing."""
    if p.vaf < 0:
        return "VAF below 0: the hand explains less than none would"
    return f"VAF {100 * p.vaf:.2f} %, NRMSE {100 * p.nrmse:.2f} %"


def show(
    result: ArmResult, profiles: Any, predictions: Any, opinions: Any, remarks: dict[str, list[str]]
) -> None:
    """Print the table and what is to be said about it; first a force that seems to be in another unit."""
    from ebac.identify.motor_check import doubts

    first = [text for text in doubts(result.recordings) if text in result.misses]
    for name, lines in remarks.items():
        for text in lines:
            output.say(f"{name}: {text}", style="dim")
    for text in first:
        output.say(text, style="bold red")
    grid = output.table(["", "estimate", "95 % interval", "profile", "unit", ""], numbers=(1, 2, 3))
    for e in result.shown:
        scale, unit = (1e3, "mm") if e.unit == "m" else (1.0, e.unit)
        wide = "-" if e.fixed else f"{scale * e.low:.4g} to {scale * e.high:.4g}"
        ends = [scale * end for end in profiles.get(e.name, ())]
        prof = "{:.4g} to {:.4g}".format(*ends) if ends else "-"
        word = "given" if e.fixed else "" if e.determined else "[red]not determined[/]"
        grid.add_row(e.name, f"{scale * e.value:.4g}", wide, prof, unit, word)
    output.show(output.filled(grid))
    for text in names(result):
        output.say(text)
    for p in predictions:
        kind = "held out" if p.held_out else "fitted"
        output.say(f"{p.recording} ({kind}): from the force alone {_fit(p)}")
    for o in opinions:
        if o.name in result.undetermined:
            output.say(
                f"{o.name}: direct not determined, by instruments {o.unbiased:.4g} +- "
                f"{1.96 * o.unbiased_deviation:.2g} {o.unit}"
            )
            continue
        output.say(
            f"{o.name}: direct {o.direct:.4g}, by instruments {o.unbiased:.4g} "
            f"+- {1.96 * o.unbiased_deviation:.2g} {o.unit}: {abs(o.apart):.1f} deviations apart"
        )
    if not opinions:
        output.say(
            "A log of a closed loop is fitted directly; without a moving target there is no second opinion."
        )
    for text in result.notes:
        output.say(columns_in_options(text))
    for text in careful(result):
        if text not in first:
            output.say(text, style="bold red")


def write(
    to: reporting.ReportOptions,
    result: ArmResult,
    predictions: Any,
    opinions: Any,
    remarks: dict[str, list[str]],
) -> list[str]:
    """Write the report page and its figures; return the names of the files."""
    from functools import partial

    from ebac.identify.figures import plot_arm

    notes = [f"{name}: {text}" for name, lines in remarks.items() for text in lines]
    notes += [*names(result), *map(columns_in_options, result.notes)]
    notes += [f"{p.recording}: {_fit(p)}{' (held out)' if p.held_out else ''}" for p in predictions]
    notes += [
        f"{o.name}: direct {o.direct:.4g} {o.unit}, by instruments {o.unbiased:.4g} {o.unit}"
        for o in opinions
    ]
    return reporting.report(
        to,
        "arm",
        title="The arm of eq. (4)",
        rows=[reporting.line(e) for e in result.shown],
        careful=careful(result),
        notes=notes,
        draw=[partial(plot_arm, result, i) for i in range(len(result.recordings))],
    )
