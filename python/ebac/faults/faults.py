"""Fault injection: thousands of runs in which something goes wrong, each judged. All of it is simulation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac import _core
from ebac._util.arguments import whole
from ebac._util.background import cancellable
from ebac._util.cores import thread_count
from ebac.trace import Trace


@dataclass(frozen=True, kw_only=True)
class FaultRow:
    """All cases of one kind.

    Attributes
    ----------
    kind, what : str
        Name and meaning.
    cases, found, failures : int
        Cases run, cases in which a fault was found, cases that did not pass.
    worst_ticks_to_zero : int
        From the row with the fault to zero torque on the bus [ticks of 1 ms].
    worst_ticks_to_off : int
        From that row to no current in any simulated motor; a drive that receives nothing keeps its last
        torque until it misses its torques (5 ms), or the heartbeat or requests of the loop (100 ms), by profile.
    reasons : dict
        Failures by their verdict.
    first_failure : int or None
        Number of the first case that failed.
    first_breach : str or None
        The rule that this case broke, with value, bound, unit, axis and tick: of the referee, which holds the
        simulated drives' own currents and the handle against a model of its own.
    """

    kind: str
    what: str
    cases: int
    found: int
    failures: int
    worst_ticks_to_zero: int
    worst_ticks_to_off: int
    reasons: dict[str, int]
    first_failure: int | None
    first_breach: str | None

    def row(self) -> dict[str, Any]:
        """Return it as a row of `--json`."""
        return {
            "kind": self.kind,
            "what": self.what,
            "count": self.cases,
            "found": self.found,
            "worst_ticks_to_zero": self.worst_ticks_to_zero,
            "worst_ticks_to_off": self.worst_ticks_to_off,
            "failures": self.failures,
            "reasons": self.reasons,
            "first_failure": self.first_failure,
            "first_breach": self.first_breach,
        }


@dataclass(frozen=True, kw_only=True, repr=False)
class FaultCampaign:
    """The result of a campaign: one row per kind."""

    seed: int
    cases: int
    passed: int
    rows: list[FaultRow]

    def __repr__(self) -> str:
        """Return a row per kind of fault."""
        from ebac._util.report import report

        title = f"Fault campaign, simulated: {self.passed} of {self.cases} cases passed, seed {self.seed}"
        shown = ("kind", "count", "found", "failures", "worst_ticks_to_zero", "worst_ticks_to_off")
        return report(title, [{key: row.row()[key] for key in shown} for row in self.rows])


@dataclass(frozen=True, kw_only=True)
class FaultCase:
    """One case, run again with its rows.

    Attributes
    ----------
    kind : str
        What goes wrong.
    trace : Trace
        Every row, the stop included.
    at, ticks : int
        First tick of the injected fault, and how many ticks it lasts.
    axis : int
        Where.
    verdict : str
        `passed`, or why not.
    breach : str or None
        The rule of the referee that it broke, with value, bound, unit, axis and tick.
    """

    kind: str
    trace: Trace
    at: int
    ticks: int
    axis: int
    verdict: str
    breach: str | None


def kinds() -> dict[str, str]:
    """Return the kinds of injected faults and what they mean; case i is of kind i modulo their number."""
    return dict(_core._fault_kinds())


def run_campaign(
    cases: int = 10_000,
    *,
    seed: int = 1,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> FaultCampaign:
    """Run cases in virtual time: two simulated drives on a CAN bus, hand, wall, law, limits, states.

    In every case the command must be zero within 2 ticks of the fault in the row, every drive disabled at
    the end, the fault named rightly, and nothing may start again by itself. A fault too short to matter must not
    stop the loop. A referee that knows device and limits, and sees only frames, drives and handle, holds every tick
    against peak, slew, heat, soft start, soft wall, speed and workspace: no current before all drives are enabled,
    none while one of them is off. Drives are watched as the shipped profiles set it, motors and encoders wired
    either way, zeros anywhere.

    Parameters
    ----------
    cases : int
        1 to 10 million; every kind in turn.
    seed : int
        The same seed gives the same cases, on any number of threads; 0 to 2^63 - 1.
    threads : int, optional
        Threads, [1, 1024]; default: one per usable core.
    progress : callable, optional
        Called with cases done and all.

    Raises
    ------
    ValueError
        For a number out of range.
    """
    for name, value, low, high in (
        ("cases", cases, 1, 10_000_000),
        ("seed", seed, 0, 2**63 - 1),
    ):
        if not low <= whole(name, value) <= high:
            raise ValueError(f"{name} = {value}: must lie in [{low}, {high}]")
    columns, verdicts = _run(cases, seed, thread_count(threads), progress)
    names = list(kinds().items())
    rows = [
        _row(name, what, columns, verdicts, np.arange(cases) % len(names) == i, seed)
        for i, (name, what) in enumerate(names)
        if i < cases
    ]
    passed = int((columns["verdict"] == 0).sum())
    return FaultCampaign(seed=seed, cases=cases, passed=passed, rows=rows)


def _run(
    cases: int, seed: int, threads: int, progress: Callable[[int, int], None] | None
) -> tuple[dict[str, NDArray[Any]], list[str]]:
    columns, verdicts = cancellable(
        lambda state: _core._fault_campaign(cases, seed, threads, state),
        None if progress is None else lambda done: progress(done, cases),
    )
    return columns, verdicts


def _row(
    kind: str,
    what: str,
    columns: dict[str, NDArray[Any]],
    verdicts: list[str],
    mine: NDArray[Any],
    seed: int,
) -> FaultRow:
    verdict = columns["verdict"][mine]
    failed = np.flatnonzero(mine)[verdict != 0]
    return FaultRow(
        kind=kind,
        what=what,
        cases=int(mine.sum()),
        found=int((columns["fault"][mine] != 0).sum()),
        failures=len(failed),
        worst_ticks_to_zero=int(columns["to_zero"][mine].max()),
        worst_ticks_to_off=int(columns["to_off"][mine].max()),
        reasons={verdicts[v]: int((verdict == v).sum()) for v in np.unique(verdict) if v != 0},
        first_failure=int(failed[0]) if len(failed) else None,
        first_breach=run_case(int(failed[0]), seed=seed).breach if len(failed) else None,
    )


def run_case(index: int, *, seed: int = 1) -> FaultCase:
    """Run one case of a campaign again and keep its rows.

    Parameters
    ----------
    index : int
        Of the case in a campaign, from 0 up.
    seed : int
        That of the campaign.

    Raises
    ------
    ValueError
        For an index below 0.
    """
    if whole("index", index) < 0:
        raise ValueError(f"index = {index}: must be at least 0")
    whole("seed", seed)
    rows, at, ticks, axis, verdict, breach = _core._fault_case(seed, index)
    names = list(kinds())
    trace = Trace.from_rows(rows, scenario=None, law="ebac", law_repr="")
    return FaultCase(
        kind=names[index % len(names)],
        trace=trace,
        at=at,
        ticks=ticks,
        axis=axis,
        verdict=verdict,
        breach=breach or None,
    )
