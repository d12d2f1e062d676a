"""`ebac bench`: how fast a law and the closed loop are, timed in C++."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import by_name, from_options, interrupts, options, output
from ebac.cli.bench import can, logs, peers, worlds

if TYPE_CHECKING:
    from ebac.laws import AnyLaw, PythonLaw
    from ebac.scenario import Scenario

#: What a law step and a closed-loop tick of one axis should take on one core [ns].
AIM_STEP, AIM_TICK = 20, 50
#: Repeats between two looks for Ctrl-C.
AT_ONCE = 50


class Spring:
    """The law in Python to compare with: what the world asks, unchanged."""

    def step(self, port: Any) -> float:
        """Return the force asked for [N]."""
        return float(port.f_env)

    def reset(self) -> None:
        """Remember nothing."""


def bench(
    setup: options.ScenarioOptions,
    law: Annotated[list[str] | None, options.laws("all, and one in Python")] = None,
    repeats: Annotated[
        int,
        typer.Option(
            help="Repetitions of the scenario; the fastest one counts.", min=1, max=100_000
        ),
    ] = 50,
    with_peers: Annotated[
        bool,
        typer.Option("--peers", help="Compare with MuJoCo and SciPy instead; needs 'ebac[peers]'."),
    ] = False,
    with_can: Annotated[
        bool,
        typer.Option("--can", help="Time frames and exchanges on a simulated CAN bus instead."),
    ] = False,
    with_logs: Annotated[
        bool, typer.Option("--logs", help="Time writing and reading of logs instead.")
    ] = False,
    with_worlds: Annotated[
        bool,
        typer.Option(
            "--worlds",
            help="Time contacts with meshes of a thousand and a million triangles instead; needs 'ebac[worlds]'.",
        ),
    ] = False,
    chai3d: Annotated[
        Path | None,
        typer.Option(
            help="Compare --worlds with CHAI3D, too: the program chai3d_contacts of examples/chai3d.",
        ),
    ] = None,
    side: Annotated[
        int,
        typer.Option(
            help="Side of the map that --peers times; it has side x side runs.", min=2, max=5000
        ),
    ] = 200,
    as_json: output.AsJson = False,
) -> None:
    """Time each law and the control loop on this machine.

    A tick includes plant, encoder, kinematics, wall, law, energy account, motor and one row of the log, for one axis
    on one core, in C++. The last row of the table is a law written in Python, in the same loop. With `--law` only those
    laws are timed, also laws of your own.

    **Examples**

    * `ebac bench --repeats 5`: every law

    * `ebac bench --device joystick --seconds 2 --repeats 5`: on another device

    * `ebac bench --law ebac,my_laws:Damped --repeats 5`: a law of your own beside `ebac`

    * `ebac bench --logs`: a log of a million rows, written and read

    * `ebac bench --can --repeats 5`: ticks and frames on a simulated CAN bus

    * `ebac bench --worlds --repeats 5`: contacts with meshes (the first time a minute longer, for the grids)
    """
    others = with_peers + with_can + with_logs + with_worlds
    if others > 1:
        output.fail(
            "--peers, --can, --logs and --worlds are comparisons of their own: give one of them"
        )
    if others and (law or any(v is not None for v in vars(setup).values())):
        output.fail(
            "--peers, --can, --logs and --worlds have scenarios and laws of their own: leave these options out"
        )
    if chai3d is not None and not chai3d.is_file():
        reason = "it is a folder" if chai3d.is_dir() else "no such file"
        output.fail(f"--chai3d {chai3d}: {reason}")
    if chai3d is not None and not with_worlds:
        output.fail("--chai3d is a part of --worlds: give that, too")
    interrupts.keeping("nothing was written; fewer --repeats take less time")
    if with_worlds:
        worlds.run(repeats, chai3d, as_json=as_json)
        return
    if with_logs:
        logs.run(as_json=as_json)
        return
    if with_can:
        can.run(repeats, as_json=as_json)
        return
    if with_peers:
        peers.run(repeats, side, as_json=as_json)
        return
    from ebac.laws import LAWS

    with output.refusing():
        scenario = from_options.scenario(setup)
        chosen: dict[str, AnyLaw] = by_name.laws(law or list(LAWS))
        if not law:
            chosen["python"] = Spring()
    rows = []
    with output.refusing(), output.progress(len(chosen), quiet=as_json) as step:
        for name, one in chosen.items():
            step(f"timing {name}")
            rows.append(_timed(name, one, scenario, repeats))
    if as_json:
        typer.echo(output.document("bench", rows))
    else:
        _show(rows)


def _best(timed: Callable[[int], float], repeats: int) -> float:
    """Return the best time of so many repeats [ns], taken a few at a time so that Ctrl-C acts soon."""
    sizes = [AT_ONCE] * (repeats // AT_ONCE) + [repeats % AT_ONCE] * (repeats % AT_ONCE > 0)
    return min(timed(size) for size in sizes)


def _timed(name: str, law: AnyLaw, scenario: Scenario, repeats: int) -> dict[str, Any]:
    """Return the row of a law; one in Python has no step of its own to time."""
    from ebac.laws import design

    made: Any = design(law, scenario.device, scenario.timing)
    step_ns = None
    if hasattr(made, "_time_tick"):
        core = scenario.setup()
        step_ns = _best(partial(made._time_step, core), repeats)
        tick_ns = _best(partial(made._time_tick, core), repeats)
    else:
        tick_ns = _time_python(made, scenario, min(repeats, 10))
    return {"law": name, "step_ns": step_ns, "tick_ns": tick_ns, "ticks_per_s": 1e9 / tick_ns}


def _time_python(law: PythonLaw, scenario: Scenario, repeats: int) -> float:
    """Return the best time of a tick under a law in Python [ns]."""
    from ebac.simulation import simulate

    best = float("inf")
    for _ in range(repeats):
        start = perf_counter()
        trace = simulate(scenario, law)
        best = min(best, (perf_counter() - start) / len(trace))
    return 1e9 * best


def _show(rows: list[dict[str, Any]]) -> None:
    grid = output.table(["law", "step", "tick", "ticks per second"], numbers=(1, 2, 3))
    for row in rows:
        step = "-" if row["step_ns"] is None else f"{row['step_ns']:.1f} ns"
        grid.add_row(row["law"], step, f"{row['tick_ns']:.1f} ns", f"{row['ticks_per_s']:,.0f}")
    grid.add_section()
    grid.add_row("aim", f"{AIM_STEP} ns", f"{AIM_TICK} ns", f"{1e9 / AIM_TICK:,.0f}")
    output.show(grid)
    compiled = [row["tick_ns"] for row in rows if row["step_ns"] is not None]
    python = [row["tick_ns"] for row in rows if row["step_ns"] is None]
    if compiled and python:
        ratio = min(python) / min(compiled)
        output.say(f"A tick under a law in Python takes {ratio:.0f} times the quickest one in C++.")
