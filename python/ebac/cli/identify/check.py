"""`ebac identify check`: the methods tried on what is known."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import interrupts, output

if TYPE_CHECKING:
    pass


class What(StrEnum):
    """What is tried."""

    ARM = "arm"
    DEVICE = "device"
    SCALE = "scale"
    GAINS = "gains"


#: How many logs each table takes.
LOGS = {What.ARM: 200, What.DEVICE: 200, What.SCALE: 200, What.GAINS: 10}
#: How long they are [s], but for those of gains.
SECONDS = {What.ARM: 10.0, What.DEVICE: 10.0, What.SCALE: 15.0}


def check(
    what: Annotated[What, typer.Argument(help="What to identify.")] = What.ARM,
    logs: Annotated[
        int | None,
        typer.Option(
            "--logs",
            help="Random logs: arms, devices, noise seeds.",
            show_default="200; 10 of gains",
            min=1,
            max=1_000_000,
        ),
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of all of them.", min=0)] = 1,
    seconds: Annotated[
        float | None,
        typer.Option(
            help="Length of each log [s], not with gains.",
            show_default="10; 15 of scale",
            min=1,
            max=1000,
        ),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            help="Processes, not with gains.", show_default="one per core", min=1, max=1024
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Check on random arms and devices how often the intervals contain the true value. A simulation.

    Each arm taps, follows a path or presses, at a wall under a law, with encoder counts and noise of the force
    sensor; one in ten never touches the wall, so its log is not informative. The command prints coverage and bias of
    each parameter. With `scale`, hands press on a soft wall to and fro, with a force sensor of another scale than the
    motor, and mass and damping are given wrong, by 10 and 20 %. With `gains`, K_p and K_d are chosen from each log and
    tested on hands that were not in it.

    **Examples**

    * `ebac identify check arm --logs 4`

    * `ebac identify check device --logs 4`
    """
    many = LOGS[what] if logs is None else logs
    interrupts.keeping("nothing is written by this command; fewer --logs take less time")
    if what is not What.GAINS:
        _intervals(what, many, seed, seconds or SECONDS[what], workers, as_json)
        return
    for option, value in (("--seconds", seconds), ("--workers", workers)):
        if value is not None:
            output.fail(f"{option} {value:g}: is not for gains, leave it out")
    _gains(many, seed, as_json)


def _intervals(
    what: What, logs: int, seed: int, seconds: float, workers: int | None, as_json: bool
) -> None:
    from ebac.identify.check import check as run

    with output.refusing(), output.counting("identifying", quiet=as_json) as progress:
        found = run(
            logs,
            what=what.value,
            seed=seed,
            seconds=seconds,
            workers=workers,
            progress=lambda done: progress(done, logs),
        )
    rows = found.rows()
    more: dict[str, Any] = {"median_fit_s": found.median_seconds()}
    if what is What.ARM:
        more |= found.unidentifiable() | _times(seed, seconds)
    if as_json:
        typer.echo(
            output.document("identify check", rows, what=what.value, logs=logs, seed=seed, **more)
        )
        return
    _table(rows)
    if what is What.ARM:
        _say_arm(more)
    output.say(f"A fit takes {1e3 * found.median_seconds():.0f} ms (median, all cores busy).")
    output.say("Simulated, not measured.", style="bold")


def _table(rows: list[dict[str, Any]]) -> None:
    grid = output.table(
        ["", "logs", "determined", "covered", "median bias", "median error"],
        numbers=(1, 2, 3, 4, 5),
    )
    for row in rows:
        share = [
            f"{100 * v:.2f} %" if v is not None else "-"
            for v in (row["covered_share"], row["median_bias"], row["median_error"])
        ]
        grid.add_row(row["parameter"], str(row["cases"]), str(row["determined"]), *share)
    output.show(grid)


def _say_arm(more: dict[str, Any]) -> None:
    output.say(
        f"Logs that do not determine M0, B0 and K0, by the truth: {more['silent_called']} of {more['silent_cases']} "
        f"called so; of those that do {more['telling_called']} of {more['telling_cases']}."
    )
    output.say(
        f"Said to be determined and wrong by half or more: {more['determined_and_wrong_by_half']} estimates."
    )
    if "fit_s" in more:
        output.say(
            f"One log alone: {1e3 * more['fit_s']:.0f} ms ({1e3 * more['fit_processor_s']:.0f} ms of the processor); "
            f"the last of its objectives by SciPy {1e3 * more['scipy_s']:.0f} ms "
            f"({1e3 * more['scipy_processor_s']:.0f} ms), optimum {more['scipy_apart_deviations']:.1g} deviations "
            "apart."
        )


def _gains(logs: int, seed: int, as_json: bool) -> None:
    from rich.markup import escape

    from ebac.identify.gains.check import LAWS, check_gains
    from ebac.identify.gains.table import gains_rows, side_by_side

    total = logs * len(LAWS)
    with output.refusing(), output.counting("choosing", quiet=as_json) as progress:
        cases = check_gains(logs, seed=seed, progress=lambda done: progress(done, total))
    rows = gains_rows(cases)
    if as_json:
        typer.echo(output.document("identify check", rows, what="gains", logs=logs, seed=seed))
        return
    heading, *lines = ([escape(cell) for cell in line] for line in side_by_side(rows))
    grid = output.table(heading, numbers=(3, 4, 5))
    for line in lines:
        grid.add_row(*line)
    output.show(grid)
    for law, many in {
        row["law"]: row["logs_refused"] for row in rows if row["logs_refused"]
    }.items():
        output.say(f"{law}: {many} logs refused, no pair of gains keeps the constraints.")
    output.say(
        "Equal: closer than another seed of the noise changes it, than a tick, a micrometre, a millinewton."
    )
    output.say("On hands that were held out. Simulated, not measured.", style="bold")


def _times(seed: int, seconds: float) -> dict[str, float]:
    """Time a fit and SciPy's `least_squares` on the same objective, in one run."""
    from ebac.identify import Recording, Target, fit_arm
    from ebac.identify.beside_scipy import compare_with_scipy
    from ebac.identify.cases import draw
    from ebac.simulation import simulate

    case = next(c for c in (draw(i, seed, seconds) for i in range(1000)) if c.task == "tapping")
    recording = Recording.from_trace(simulate(case.scenario, case.law))
    result = fit_arm(recording, Target.of(case.scenario.hand, recording.t))
    try:
        c = compare_with_scipy(result)
    except ModuleNotFoundError:
        return {}
    return {
        "fit_s": c.ours_s,
        "fit_processor_s": c.ours_cpu_s,
        "scipy_s": c.scipy_s,
        "scipy_processor_s": c.scipy_cpu_s,
        "scipy_apart_deviations": c.apart,
    }
