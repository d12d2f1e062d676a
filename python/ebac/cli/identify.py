"""`ebac identify`: from logs to models."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.identify import ArmResult, Recording, Target

app = typer.Typer(
    no_args_is_help=True,
    help="From logs to models: the arm, the device, and how far to trust them.",
)

_LOG, _FIT, _RUN = "Log", "Fit", "Run"
Logs = Annotated[
    list[Path],
    typer.Argument(help="CSV, .mat or .npz; several are fitted together.", show_default=False),
]
ColumnOf = Annotated[
    list[str] | None,
    typer.Option(
        "--column",
        help="SIGNAL=COLUMN: t, x, force, motor, desired or target.",
        show_default="guessed",
        rich_help_panel=_LOG,
    ),
]
UnitOf = Annotated[
    list[str] | None,
    typer.Option(
        "--unit",
        help="SIGNAL=UNIT, as x=mm.",
        show_default="from the heading, else SI",
        rich_help_panel=_LOG,
    ),
]
Rate = Annotated[
    float | None,
    typer.Option(
        help="Rows per second [Hz], for a log without time.",
        show_default=False,
        rich_help_panel=_LOG,
    ),
]
Lag = Annotated[
    float | None,
    typer.Option(
        help="Lag of the force sensor [s].",
        show_default="of the trace, else 0",
        rich_help_panel=_LOG,
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        help="Folder for the report page and figures.",
        show_default=False,
        rich_help_panel=_RUN,
    ),
]


def pairs(given: list[str] | None, option: str) -> dict[str, str]:
    """Split NAME=VALUE."""
    out = {}
    for text in given or []:
        name, mark, value = text.partition("=")
        if not mark or not name or not value:
            raise ValueError(f"{option} {text}: write NAME=VALUE")
        out[name] = value
    return out


def numbers(given: list[str] | None, option: str) -> dict[str, float]:
    """Split NAME=NUMBER."""
    out = {}
    for name, text in pairs(given, option).items():
        try:
            out[name] = float(text)
        except ValueError:
            raise ValueError(f"{option} {name}={text}: {text!r} is no number") from None
    return out


@app.command("arm")
def arm(
    logs: Logs,
    column: ColumnOf = None,
    unit: UnitOf = None,
    rate: Rate = None,
    lag: Lag = None,
    switch: Annotated[
        list[float] | None,
        typer.Option(
            help="Time [s] at which the hand was told to go elsewhere; repeat it.",
            show_default="held in one place",
            rich_help_panel=_FIT,
        ),
    ] = None,
    tapping: Annotated[
        float | None,
        typer.Option(
            help="The hand taps at this frequency [Hz].", show_default=False, rich_help_panel=_FIT
        ),
    ] = None,
    fix: Annotated[
        list[str] | None,
        typer.Option(
            help="NAME=VALUE in SI units: M0, B0, K0, X0, delay.",
            show_default=False,
            rich_help_panel=_FIT,
        ),
    ] = None,
    free: Annotated[
        list[str] | None,
        typer.Option(help="Fit delay or onset too.", show_default=False, rich_help_panel=_FIT),
    ] = None,
    hold_out: Annotated[
        list[Path] | None,
        typer.Option(
            help="A log of the same arm to judge the fit on; not fitted.",
            show_default=False,
            rich_help_panel=_FIT,
        ),
    ] = None,
    robust: Annotated[
        float | None,
        typer.Option(
            help="Errors beyond so many deviations count linearly.",
            show_default=False,
            rich_help_panel=_FIT,
        ),
    ] = None,
    starts: Annotated[int, typer.Option(help="Starts of the search.", rich_help_panel=_FIT)] = 1,
    profile: Annotated[
        bool,
        typer.Option(
            "--profile", help="Profile likelihood intervals too (slower).", rich_help_panel=_FIT
        ),
    ] = False,
    out: Out = None,
    as_json: output.AsJson = False,
) -> None:
    """Identify the human arm of eq. (4): M0, B0, K0 and where it wanted to be.

    Needs position and force of the hand. A column `target` in the log is taken as the path the hand followed.

    **Examples**

    * `ebac identify arm press.csv --switch 1.0`

    * `ebac identify arm log.mat --column force=Fz --unit x=mm --lag 0.0008 --out report`
    """
    from ebac.identify import fit_arm
    from ebac.identify.load import load

    with output.refusing():

        def read(path: Path) -> Recording:
            return load(
                path,
                columns=pairs(column, "--column"),
                units=pairs(unit, "--unit"),
                rate=rate,
                lag=lag,
            )

        recordings = [read(path) for path in logs]
        targets = [_target(r, switch, tapping) for r in recordings]
        held = [(r, _target(r, switch, tapping)) for r in map(read, hold_out or [])]
        result = fit_arm(
            recordings,
            targets,
            fixed=numbers(fix, "--fix"),
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
    files = _write(out, result, predictions, opinions, remarks)
    if as_json:
        more = result.to_dict()
        more.pop("rows")
        more["predictions"] = [vars(p) for p in predictions]
        second = [{**vars(o), "apart": o.apart} for o in opinions]
        typer.echo(
            output.document("identify arm", rows, **more, remarks=remarks, second_opinion=second)
        )
        return
    _show(result, profiles, predictions, opinions, remarks)
    if out is not None:
        output.list_files(out, files)


def _target(r: Recording, switch: list[float] | None, tapping: float | None) -> Target:
    from ebac.identify import Target

    if switch and tapping:
        raise ValueError("--switch and --tapping: give one of them")
    if tapping:
        return Target.tapping(tapping, r.seconds, float(r.t[0]))
    if switch:
        return Target.steps(*sorted(switch))
    return Target.held() if r.target is None else Target.following(r.target)


def _profiles(result: ArmResult) -> dict[str, tuple[float, float]]:
    return {name: result.profile(name) for name, e in result.estimates.items() if not e.fixed}


def _opinions(result: ArmResult) -> tuple[Any, ...]:
    from ebac.identify.unbiased import second_opinion

    try:
        return second_opinion(result)
    except ValueError:
        return ()


def _careful(result: ArmResult) -> list[str]:
    out = [f"{name} is not determined by this log." for name in result.undetermined]
    out += [
        f"{a} and {b} cannot be told apart in this log (correlation {r:+.3f})."
        for a, b, r in result.inseparable
    ]
    for name, t in result.tests.items():
        if not t.white:
            out.append(
                f"{name}: the errors are not white "
                f"(largest correlation {abs(t.auto).max():.2f}); the model misses something."
            )
        if not t.independent:
            out.append(
                f"{name}: the errors follow the force "
                f"(correlation {abs(t.cross).max():.2f}); closed loop, or the model misses something."
            )
    return out


def _show(
    result: ArmResult, profiles: Any, predictions: Any, opinions: Any, remarks: dict[str, list[str]]
) -> None:
    for name, lines in remarks.items():
        for text in lines:
            output.say(f"{name}: {text}", style="dim")
    grid = output.table(["", "estimate", "95 % interval", "profile", "unit", ""], numbers=(1, 2, 3))
    for e in result.estimates.values():
        if e.fixed and e.name not in ("M0", "B0", "K0"):
            continue
        wide = "-" if e.fixed else f"{e.low:.4g} to {e.high:.4g}"
        prof = "-" if e.name not in profiles else "{:.4g} to {:.4g}".format(*profiles[e.name])
        word = "given" if e.fixed else "" if e.determined else "[red]not determined[/]"
        grid.add_row(e.name, f"{e.value:.4g}", wide, prof, e.unit, word)
    output.console().print(grid)
    for p in predictions:
        kind = "held out" if p.held_out else "fitted"
        output.say(
            f"{p.recording} ({kind}): from the force alone VAF {100 * p.vaf:.2f} %, NRMSE {100 * p.nrmse:.2f} %"
        )
    for o in opinions:
        output.say(
            f"{o.name}: direct {o.direct:.4g}, by instruments {o.unbiased:.4g} "
            f"+- {1.96 * o.unbiased_deviation:.2g} {o.unit}: {abs(o.apart):.1f} deviations apart"
        )
    if not opinions:
        output.say(
            "A log of a closed loop is fitted directly; without a moving target there is no second opinion."
        )
    for text in _careful(result):
        output.say(text, style="bold red")


def _write(
    folder: Path | None,
    result: ArmResult,
    predictions: Any,
    opinions: Any,
    remarks: dict[str, list[str]],
) -> list[str]:
    from ebac.identify.figures import plot_arm
    from ebac.identify.report import page

    with output.results(folder) as draft:
        if draft is None:
            return []
        figures = [plot_arm(result, i) for i in range(len(result.recordings))]
        for i, figure in enumerate(figures):
            figure.savefig(draft / f"arm-{i + 1}.png")
        rows = [
            {
                "parameter": e.name,
                "estimate": f"{e.value:.5g}",
                "95 % interval": "given" if e.fixed else f"{e.low:.5g} to {e.high:.5g}",
                "unit": e.unit,
            }
            for e in result.estimates.values()
        ]
        notes = [f"{name}: {text}" for name, lines in remarks.items() for text in lines]
        notes += [
            f"{p.recording}: VAF {100 * p.vaf:.2f} %, NRMSE {100 * p.nrmse:.2f} %{' (held out)' if p.held_out else ''}"
            for p in predictions
        ]
        notes += [
            f"{o.name}: direct {o.direct:.4g} {o.unit}, by instruments {o.unbiased:.4g} {o.unit}"
            for o in opinions
        ]
        (draft / "arm.html").write_text(
            page("The arm of eq. (4)", rows, _careful(result), notes, figures), encoding="utf-8"
        )
        return sorted(file.name for file in draft.iterdir())


@app.command("device")
def device(
    log: Annotated[Path, typer.Argument(help="CSV, .mat or .npz.", show_default=False)],
    column: ColumnOf = None,
    unit: UnitOf = None,
    rate: Rate = None,
    lag: Lag = None,
    current_lag: Annotated[
        float, typer.Option(help="Lag of the current loop [s].", rich_help_panel=_FIT)
    ] = 3e-4,
    as_json: output.AsJson = False,
) -> None:
    """Identify the device: mass and damping, Coulomb and Stribeck friction, weight; and tau_static of eq. (2).

    Needs position, and the motor's force or the hand's, which moves it both ways.

    **Example**: `ebac identify device excited.csv`
    """
    from ebac.identify import fit_device
    from ebac.identify.load import load

    with output.refusing():
        recording = load(
            log, columns=pairs(column, "--column"), units=pairs(unit, "--unit"), rate=rate, lag=lag
        )
        result = fit_device(recording, current_lag=current_lag)
    if as_json:
        more = result.to_dict()
        rows = more.pop("rows")
        typer.echo(
            output.document("identify device", rows, **more, remarks=list(recording.remarks))
        )
        return
    for text in recording.remarks:
        output.say(text, style="dim")
    grid = output.table(["", "estimate", "95 % interval", "unit", ""], numbers=(1, 2))
    for e in result.estimates.values():
        word = "" if e.determined else "[red]not determined[/]"
        grid.add_row(e.name, f"{e.value:.4g}", f"{e.low:.4g} to {e.high:.4g}", e.unit, word)
    output.console().print(grid)
    output.say(
        f"Explains {100 * result.explained:.2f} % of the force. For the device: {result.compensation!r}"
    )


@app.command("check")
def check(
    arms: Annotated[int, typer.Option(help="Random arms, devices and noise seeds.")] = 200,
    seed: Annotated[int, typer.Option(help="Seed of all of them.")] = 1,
    seconds: Annotated[float, typer.Option(help="Length of each log [s].")] = 10.0,
    workers: Annotated[
        int | None, typer.Option(help="Processes.", show_default="one per core")
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Try the method on random arms: how often do the intervals hold the truth? A simulation.

    Each arm taps, follows a path or presses, at a wall under a law, with encoder counts and noise of the force
    sensor; one in ten
    never meets the wall, and its log tells nothing. Prints coverage and bias of every parameter.

    **Example**: `ebac identify check --arms 200 --seed 1`
    """
    from ebac.identify.check import check as run

    with output.refusing(), output.counting("identifying", quiet=as_json) as progress:
        found = run(
            arms,
            seed=seed,
            seconds=seconds,
            workers=workers,
            progress=lambda done: progress(done, arms),
        )
    rows, calls, times = found.rows(), found.unidentifiable(), _times(seed, seconds)
    if as_json:
        typer.echo(
            output.document(
                "identify check",
                rows,
                arms=arms,
                seed=seed,
                median_fit_s=found.median_seconds(),
                **calls,
                **times,
            )
        )
        return
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
    output.console().print(grid)
    output.say(
        f"Logs that tell nothing of the arm: {calls['free_called']} of {calls['free_cases']} called so; "
        f"of the others {calls['other_called']} of {calls['other_cases']}."
    )
    output.say(
        f"Said to be determined and wrong by half or more: {calls['determined_and_wrong_by_half']} estimates."
    )
    output.say(f"A fit takes {1e3 * found.median_seconds():.0f} ms (median, all cores busy).")
    if times:
        output.say(
            f"One log alone: {1e3 * times['fit_s']:.0f} ms; the same objective by SciPy "
            f"{1e3 * times['scipy_s']:.0f} ms, optimum {times['scipy_apart_deviations']:.1g} deviations apart."
        )
    output.say("Simulated, not measured.", style="bold")


def _times(seed: int, seconds: float) -> dict[str, float]:
    from ebac.identify import Recording, Target, fit_arm
    from ebac.identify.check import draw
    from ebac.identify.peer import compare_with_scipy
    from ebac.simulation import simulate

    case = next(c for c in (draw(i, seed, seconds) for i in range(1000)) if c.task == "tapping")
    recording = Recording.from_trace(simulate(case.scenario, case.law))
    result = fit_arm(recording, Target.of(case.scenario.hand, recording.t))
    try:
        c = compare_with_scipy(result)
    except ModuleNotFoundError:
        return {}
    return {"fit_s": c.ours_s, "scipy_s": c.scipy_s, "scipy_apart_deviations": c.apart}
