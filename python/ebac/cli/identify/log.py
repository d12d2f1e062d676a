"""`ebac identify log`: what a log excites, before anything is fitted."""

from __future__ import annotations

from typing import Annotated

import typer

from ebac.cli import identify_options as given
from ebac.cli import output


def log(
    logs: given.Logs,
    ask: Annotated[
        list[str] | None,
        typer.Option(
            help="A parameter the log shall tell: M0, B0, K0; repeat it.",
            show_default="all three",
            rich_help_panel=given.FIT,
        ),
    ] = None,
    column: given.ColumnOf = None,
    unit: given.UnitOf = None,
    rate: given.Rate = None,
    lag: given.Lag = None,
    axis: given.Axis = 0,
    switch: given.Switch = None,
    tapping: given.Tapping = None,
    as_json: output.AsJson = False,
) -> None:
    """Say what a log excites: its bands, and whether it can tell what is asked of it.

    Ends with exit code 1 when it cannot.

    **Example**: `ebac identify log tap.mcap --tapping 1.5 --ask M0 --ask K0`
    """
    from ebac.identify import check_log

    reading = given.Reading(column=column, unit=unit, rate=rate, lag=lag, axis=axis)
    with output.refusing():
        found = []
        for path in logs:
            r = reading.load(path)
            found.append(
                check_log(r, given.target_of(r, switch, tapping), ask=ask or ("M0", "B0", "K0"))
            )
    rows = [row for one in found for row in one.rows()]
    if as_json:
        bands = {one.name: [list(band) for band in one.bands] for one in found}
        typer.echo(output.document("identify log", rows, bands_Hz=bands))
    else:
        for one in found:
            output.say(f"{one.name}: excites {one.bands_in_words()}")
            grid = output.table(["", "tells it", "expected deviation", ""], numbers=(2,))
            for row in one.rows():
                share = row["deviation_share"]
                grid.add_row(
                    row["parameter"],
                    "yes" if row["told"] else "[red]no[/]",
                    f"{100 * share:.2g} %" if share is not None and share < 10 else "-",
                    row["remedy"],
                )
            output.console().print(grid)
    if not all(row["told"] for row in rows):
        raise typer.Exit(output.FAILED)
