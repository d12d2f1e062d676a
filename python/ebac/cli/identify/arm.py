"""`ebac identify arm`: the hand of eq. (4)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import identify_options as given
from ebac.cli import output
from ebac.cli.identify_arm_results import show, write

if TYPE_CHECKING:
    from ebac.identify import ArmResult


def arm(
    logs: given.Logs,
    column: given.ColumnOf = None,
    unit: given.UnitOf = None,
    rate: given.Rate = None,
    lag: given.Lag = None,
    current_lag: given.CurrentLag = None,
    axis: given.Axis = 0,
    switch: given.Switch = None,
    tapping: given.Tapping = None,
    fix: given.Fix = None,
    free: Annotated[
        list[str] | None,
        typer.Option(help="Fit delay or onset too.", show_default=False, rich_help_panel=given.FIT),
    ] = None,
    hold_out: Annotated[
        list[Path] | None,
        typer.Option(
            help="A log of the same arm to judge the fit on; not fitted.",
            show_default=False,
            rich_help_panel=given.FIT,
        ),
    ] = None,
    robust: given.Robust = None,
    starts: Annotated[
        int, typer.Option(help="Starts of the search.", rich_help_panel=given.FIT)
    ] = 1,
    profile: Annotated[
        bool,
        typer.Option(
            "--profile",
            help="Profile likelihood intervals too (slower).",
            rich_help_panel=given.FIT,
        ),
    ] = False,
    out: given.Out = None,
    as_json: output.AsJson = False,
) -> None:
    """Identify the human arm of eq. (4): M0, B0, K0 and where it wanted to be.

    Needs position and force of the hand. A column `target` in the log is taken as the path the hand followed.

    **Examples**

    * `ebac identify arm press.csv --switch 1.0`

    * `ebac identify arm log.mat --column force=Fz --unit x=mm --lag 0.0008 --out report`
    """
    from ebac.identify import fit_arm

    reading = given.Reading(
        column=column, unit=unit, rate=rate, lag=lag, current_lag=current_lag, axis=axis
    )
    with output.refusing():
        recordings = [reading.load(path) for path in logs]
        targets = [given.target_of(r, switch, tapping) for r in recordings]
        held = [(r, given.target_of(r, switch, tapping)) for r in map(reading.load, hold_out or [])]
        result = fit_arm(
            recordings,
            targets,
            fixed=given.numbers(fix, "--fix"),
            free=free or [],
            robust=robust,
            starts=starts,
        )
        profiles = _profiles(result) if profile else {}
        predictions = result.predictions(held)
        opinions = _opinions(result)
    rows = [
        {**vars(e), "profile_low": None, "profile_high": None} for e in result.estimates.values()
    ]
    for row in rows:
        if row["name"] in profiles:
            row["profile_low"], row["profile_high"] = profiles[row["name"]]
    remarks = {r.name: list(r.remarks) for r in recordings}
    files = write(out, result, predictions, opinions, remarks)
    if as_json:
        more = result.to_dict()
        more.pop("rows")
        more["predictions"] = [vars(p) for p in predictions]
        second = [{**vars(o), "apart": o.apart} for o in opinions]
        typer.echo(
            output.document("identify arm", rows, **more, remarks=remarks, second_opinion=second)
        )
        return
    show(result, profiles, predictions, opinions, remarks)
    if out is not None:
        output.list_files(out, files)


def _profiles(result: ArmResult) -> dict[str, tuple[float, float]]:
    return {name: result.profile(name) for name, e in result.estimates.items() if not e.fixed}


def _opinions(result: ArmResult) -> tuple[Any, ...]:
    from ebac.identify.unbiased import second_opinion

    try:
        return second_opinion(result)
    except ValueError:
        return ()
