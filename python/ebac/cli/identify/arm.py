"""`ebac identify arm`: the hand of eq. (4)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import output
from ebac.cli.identify import options as given
from ebac.cli.identify import report as reporting
from ebac.cli.identify.arm_results import show, write

if TYPE_CHECKING:
    from ebac.identify import ArmResult


def arm(
    logs: given.Logs,
    reading: given.Reading,
    target: given.TargetOptions,
    to: reporting.ReportOptions,
    fix: given.Fix = None,
    free: Annotated[
        list[str] | None,
        typer.Option(
            help="Also fit delay or onset.", show_default=False, rich_help_panel=given.FIT
        ),
    ] = None,
    hold_out: Annotated[
        list[Path] | None,
        typer.Option(
            help="A second log of the same arm, to judge the fit; it is not used in the fit.",
            show_default=False,
            rich_help_panel=given.FIT,
        ),
    ] = None,
    robust: given.Robust = None,
    starts: Annotated[
        int,
        typer.Option(
            help="Number of starting points of the search.",
            min=1,
            max=1000,
            rich_help_panel=given.FIT,
        ),
    ] = 1,
    profile: Annotated[
        bool,
        typer.Option(
            "--profile",
            help="Also compute profile likelihood intervals (slower).",
            rich_help_panel=given.FIT,
        ),
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Identify a human arm, eq. (4): mass M0, damping B0, stiffness K0 and the position it moves to.

    The log must contain position and force of the hand. A column `target` is taken as the path that the hand
    followed.

    **Examples**

    * `ebac demo arm`, then `ebac identify arm arm.csv`: a perturbed arm

    * `ebac demo tapping`, then `ebac identify arm tapping.mcap --out report`

    Exit code 1 when the log determines nothing of the hand, or when the result is not a plausible one, because it
    explains less of the motion than no hand would, of the log or of one that was held out.
    """
    from ebac.identify import fit_arm

    to.folder()
    with output.refusing():
        every = given.given_logs([*logs, *(hold_out or [])], reading, target)
        pairs, others = every[: len(logs)], every[len(logs) :]
        recordings, targets = [r for r, _ in pairs], [one for _, one in pairs]
        result = fit_arm(
            recordings,
            targets,
            fixed=given.numbers(fix, "--fix"),
            free=free or [],
            robust=robust,
            starts=starts,
        )
        profiles = _profiles(result) if profile else {}
        predictions = result.predictions(others)
        opinions = _opinions(result)
    rows = [
        {**vars(e), "profile_low": None, "profile_high": None} for e in result.estimates.values()
    ]
    for row in rows:
        if row["name"] in profiles:
            row["profile_low"], row["profile_high"] = profiles[row["name"]]
    remarks = {r.name: list(r.remarks) for r in recordings}
    files = write(to, result, predictions, opinions, remarks)
    if as_json:
        more = result.to_dict()
        more.pop("rows")
        more["predictions"] = [vars(p) for p in predictions]
        second = [{**vars(o), "apart": o.apart} for o in opinions]
        typer.echo(
            output.document("identify arm", rows, **more, remarks=remarks, second_opinion=second)
        )
    else:
        show(result, profiles, predictions, opinions, remarks)
        if to.out is not None:
            output.list_files(to.out, files)
    if result.impossible:
        output.fail(f"This is no hand: {'; '.join(result.impossible)}.", code=output.FAILED)
    if lost := [p.recording for p in predictions if p.held_out and p.vaf < 0]:
        output.fail(
            f"{', '.join(lost)}: held out, and this hand explains less of the motion than none would. Is it the same "
            "arm, and the target the right one? --switch, --tapping and --held apply to every log, a column target to "
            "its own.",
            code=output.FAILED,
        )
    if result.nothing_determined:
        raise typer.Exit(output.FAILED)


def _profiles(result: ArmResult) -> dict[str, tuple[float, float]]:
    return {name: result.profile(name) for name, e in result.estimates.items() if not e.fixed}


def _opinions(result: ArmResult) -> tuple[Any, ...]:
    from ebac.identify.unbiased import second_opinion

    try:
        return second_opinion(result)
    except ValueError:
        return ()
