"""`ebac identify log`: what a log excites, before anything is fitted."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import output
from ebac.cli.identify import options as given

if TYPE_CHECKING:
    from ebac.identify import Target

#: Taps as a metronome has them are as evenly spaced as this [s].
EVEN = 1e-6


def log(
    logs: given.Logs,
    reading: given.Reading,
    target: given.TargetOptions,
    ask: Annotated[
        list[str] | None,
        typer.Option(
            help="Parameters to identify: M0, B0, K0, separated by commas.",
            show_default="all three",
            rich_help_panel=given.FIT,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Check whether a log is informative enough to identify the requested parameters.

    Exit code 1 when it is not.

    **Examples**

    * `ebac demo arm`, then `ebac identify log arm.csv`

    * `ebac demo tapping`, then `ebac identify log tapping.mcap --ask M0,K0`
    """
    from ebac.identify import check_log

    with output.refusing():
        wanted = output.words(ask)
        pairs = given.given_logs(logs, reading, target)
        found = [check_log(*pair, ask=wanted or ("M0", "B0", "K0")) for pair in pairs]
    rows = [row for one in found for row in one.rows()]
    if as_json:
        bands = {one.name: [list(band) for band in one.bands] for one in found}
        typer.echo(output.document("identify log", rows, bands_Hz=bands))
    else:
        for one, (r, target_of) in zip(found, pairs, strict=True):
            for text in r.remarks:
                output.say(f"{one.name}: {text}", style="dim")
            output.say(f"{one.name}: excites {one.bands_in_words()}")
            grid = output.table(["", "determined", "expected deviation", ""], numbers=(2,))
            for row in one.rows():
                share = row["deviation_share"]
                grid.add_row(
                    row["parameter"],
                    "yes" if row["told"] else "[red]no[/]",
                    f"{100 * share:.2g} %" if share is not None and share < 10 else "-",
                    row["remedy"],
                )
            output.show(output.filled(grid))
            if text := _of_target(target_of, all(row["told"] for row in one.rows())):
                output.say(f"{one.name}: {text}")
    if not all(row["told"] for row in rows):
        raise typer.Exit(output.FAILED)


def _of_target(target: Target, determined: bool) -> str:
    """Return what the target that was given means for the forecast; `determined`: whether all of it is."""
    if len(target.switches) == 1:
        return (
            "the target changes once. The forecast says what the spectra could show at best; a fit often determines "
            "less. Let the hand press several times, or tap."
        )
    if determined or target.path is not None:
        return ""
    other = "record the path that it was shown as a column target, or give its times by --switch"
    if not target.switches:
        return (
            f"the hand was taken as held in one place. If it moved on its own, as in taps, {other}."
        )
    steps = [b - a for a, b in pairwise(target.switches)]
    if max(steps) - min(steps) < EVEN:
        return (
            "the target is that of a metronome. Taps must be on the beat within 3 ms, those of a person are off by 10 "
            f"to 30 ms: if a person tapped, {other}."
        )
    return ""
