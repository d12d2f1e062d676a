"""Laws before an engine that is slower than the loop: its force held, or its local model rendered in every tick."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from ebac._core import BridgeParams, EngineTiming, Wall
from ebac._util.arguments import require
from ebac._util.sequences import several, several_numbers
from ebac._util.wrong_calls import plain_function
from ebac.laws import AnyLaw, law_name
from ebac.metrics import contact
from ebac.scenario import Environment, Scenario
from ebac.simulation import LoopFault, simulate
from ebac.studies.measures import SPARE
from ebac.trace import Trace
from ebac.worlds import Bridge, World, preset

#: Laws that are compared unless others are given.
LAWS = ("direct", "tca-damped", "passivity-control", "ebac")
#: Rates of the engine [Hz], its jitter [s].
RATES, JITTER = (60.0, 500.0), 0.01
#: How the world is met: in every tick, and by an engine in two ways.
EVERY_TICK, HELD, MODEL = "every tick", "force held", "local model"


@dataclass(frozen=True, kw_only=True)
class EngineRow:
    """One run.

    Attributes
    ----------
    law : str
        Name.
    rate_Hz, jitter_s, compute_s : float or None
        Of the engine; None where the world is computed in every tick.
    rendered : str
        "every tick", "force held" or "local model".
    still, quiet : bool
        As in `ebac.contact`.
    exact : bool or None
        As in `ebac.contact`.
    passive : bool
        The port gave out at most 1 mJ.
    swing_m, peak_m, deviation_m, least_energy_J, jumps
        As in `ebac.contact`; None for a run that a fault ended.
    oldest_s, given_J : float or None
        Of the bridge: oldest model, most energy that updates can have given.
    """

    law: str
    rate_Hz: float | None
    jitter_s: float | None
    compute_s: float | None
    rendered: str
    still: bool
    quiet: bool
    exact: bool | None
    passive: bool
    swing_m: float | None = None
    peak_m: float | None = None
    deviation_m: float | None = None
    least_energy_J: float | None = None
    jumps: int | None = None
    oldest_s: float | None = None
    given_J: float | None = None


@dataclass(frozen=True, kw_only=True)
class Engines:
    """What `engines` found.

    Attributes
    ----------
    base : Scenario
        The scenario, its world computed in every tick.
    rows : tuple of EngineRow
        For each law: every tick, then each rate, held and local model.
    traces : tuple of Trace
        The run of each row.
    """

    base: Scenario
    rows: tuple[EngineRow, ...]
    traces: tuple[Trace, ...]

    def table(self) -> list[dict[str, object]]:
        """Return the rows as dictionaries, units in the keys."""
        return [asdict(row) for row in self.rows]


@plain_function
def engines(
    laws: Sequence[AnyLaw] = LAWS,
    *,
    base: Scenario | None = None,
    rates: Sequence[float] = RATES,
    jitter: float = JITTER,
    compute: float | None = None,
    rendering: BridgeParams | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Engines:
    """Simulate each law with the world in every tick, then by an engine: its force held, and its local model.

    Parameters
    ----------
    laws : sequence of laws
        As `simulate` takes them.
    base : Scenario, optional
        Its environment is a `worlds.World` or a straight wall. Default: a plane of 10 kN/m, 10 mm from the handle, 4 s.
    rates : sequence of float
        Calls of the engine [Hz], [1, 1000].
    jitter : float
        Answers come late by up to so much at random [s], [0, 1].
    compute : float, optional
        From a call to its answer, at least [s], [0, 1]; default: one period of the engine.
    rendering : BridgeParams, optional
        How models take over from each other.
    progress : callable, optional
        Called with runs done and all.

    Raises
    ------
    ValueError
        For a world that no engine can compute, or a number out of its range.
    """
    if base is None:
        base = Scenario(environment=preset("plane", position=0.01), seconds=4.0)
    require(base, Scenario, "ebac.studies.engines", "a Scenario as its base")
    chosen = several("engines: laws", laws)
    world = _bodies(base.environment)
    scenario = base.replace(environment=world)
    worlds: list[World | Bridge] = [world]
    for rate in several_numbers("engines: rates", rates):
        how: Any = {"rate": rate, "jitter": jitter, "compute": compute, "seed": scenario.seed}
        worlds += [
            behind_engine(world, held=held, rendering=rendering, **how) for held in (True, False)
        ]
    rows, traces = [], []
    for law in chosen:
        for one in worlds:
            row, trace = _run(scenario.replace(environment=one), law)
            rows.append(row)
            traces.append(trace)
            if progress is not None:
                progress(len(rows), len(chosen) * len(worlds))
    return Engines(base=scenario, rows=tuple(rows), traces=tuple(traces))


def behind_engine(
    environment: Environment,
    *,
    rate: float,
    jitter: float = 0.0,
    compute: float | None = None,
    seed: int = 1,
    held: bool = False,
    rendering: BridgeParams | None = None,
) -> Bridge:
    """Return a world of bodies, or a wall, as an engine computes it; numbers as in `engines`.

    Raises
    ------
    ValueError
        For a world that no engine computes; as `Bridge`, for an elastic body with damping.
    """
    late = 1 / rate if compute is None and rate > 0 else compute or 0.0
    timing = EngineTiming(rate=rate, jitter=jitter, compute=late, seed=seed)
    return Bridge(_bodies(environment), timing=timing, held=held, rendering=rendering)


def _bodies(world: Environment) -> World:
    """Return a world of bodies, or a wall as one."""
    if isinstance(world, World):
        return world
    if isinstance(world, Wall) and world.angle == 0 and world.motion_amplitude == 0:
        return preset(
            "plane", stiffness=world.stiffness, damping=world.damping, position=world.position
        )
    raise ValueError(
        f"environment = {world!r}: an engine computes a worlds.World, or a wall across the first axis that stands still"
    )


def _run(scenario: Scenario, law: AnyLaw) -> tuple[EngineRow, Trace]:
    world = scenario.environment
    bridge = world if isinstance(world, Bridge) else None
    known: dict[str, Any] = {
        "law": law_name(law),
        "rate_Hz": bridge and bridge.timing.rate,
        "jitter_s": bridge and bridge.timing.jitter,
        "compute_s": bridge and bridge.timing.compute,
        "rendered": EVERY_TICK if bridge is None else HELD if bridge.held else MODEL,
    }
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of models that are too old: a column
            trace = simulate(scenario, law)
    except LoopFault as fault:
        if fault.__cause__ is not None:  # an error in Python code of a user's own
            raise
        judged: dict[str, Any] = {"still": False, "quiet": False, "exact": None, "passive": False}
        return EngineRow(**known, **judged), fault.trace
    met = contact(trace)
    rendered = bridge is not None and not bridge.held
    report = bridge.report if bridge is not None and rendered else None
    return EngineRow(
        **known,
        still=met.still,
        quiet=met.quiet,
        exact=met.exact,
        passive=(met.least_energy_J or 0.0) >= -SPARE,
        swing_m=met.swing_m,
        peak_m=met.peak_m,
        deviation_m=met.deviation_m,
        least_energy_J=met.least_energy_J,
        jumps=met.jumps,
        oldest_s=None if report is None else report.oldest_s,
        given_J=None if report is None else report.given_J,
    ), trace
