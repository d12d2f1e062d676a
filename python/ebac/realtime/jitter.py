"""How late a thread wakes that does nothing but wait for its ticks."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import ceil
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ebac import _core
from ebac._util.arguments import number
from ebac.realtime.mode import Mode, mode_named

#: The longest that is measured [s].
LONGEST = 86400.0
#: Turns of two programs that are measured side by side last no longer [s].
_TURN = 2.0
#: Shares of the wake-ups reported in numbers.
PERCENTILES = (50.0, 99.0, 99.9)


@dataclass(frozen=True, kw_only=True)
class Jitter:
    """Wake-ups of a thread.

    Attributes
    ----------
    lateness : array, shape (wake-ups,)
        From the planned instant to the wake-up [s].
    dt : float
        Time between two planned instants [s].
    skipped : int
        Ticks that could not be kept.
    grants : list of Grant
        What the thread asked of the system, and what it got.
    """

    lateness: NDArray[np.float64]
    dt: float
    skipped: int
    grants: list[_core.Grant]

    @classmethod
    def pooled(cls, parts: Sequence[Self]) -> Self:
        """Return several measurements of one thread as one."""
        return replace(
            parts[0],
            lateness=np.concatenate([part.lateness for part in parts]),
            skipped=sum(part.skipped for part in parts),
        )

    def row(self) -> dict[str, Any]:
        """Return its numbers as a row of `--json`."""
        p50, p99, p999 = np.percentile(self.lateness, PERCENTILES)
        return {
            "program": "ebac",
            "wakeups": len(self.lateness),
            "mean_s": float(self.lateness.mean()),
            "p50_s": float(p50),
            "p99_s": float(p99),
            "p99_9_s": float(p999),
            "most_s": float(self.lateness.max()),
            "skipped": self.skipped,
        }

    def __repr__(self) -> str:
        """Return one line: wake-ups, lateness, ticks skipped."""
        row = self.row()
        return (
            f"<Jitter: {row['wakeups']} wake-ups every {1e3 * self.dt:.4g} ms; late by {1e6 * row['p50_s']:.3g} us "
            f"(median), {1e6 * row['p99_s']:.3g} us (99 %), {1e6 * row['most_s']:.3g} us at most; "
            f"{self.skipped} skipped; each in .lateness>"
        )


@dataclass(frozen=True, kw_only=True)
class Cyclictest:
    """The same of `cyclictest` (rt-tests), in whole microseconds.

    Attributes
    ----------
    counts : array, shape (microseconds,)
        Wake-ups that were this many whole microseconds late.
    beyond : int
        Wake-ups later than the longest of these.
    most : float
        Latest wake-up [s].
    """

    counts: NDArray[np.int64]
    beyond: int
    most: float

    @classmethod
    def pooled(cls, parts: Sequence[Self]) -> Self:
        """Return several measurements as one."""
        counts = np.zeros(max(len(part.counts) for part in parts), np.int64)
        for part in parts:
            counts[: len(part.counts)] += part.counts
        beyond, most = sum(part.beyond for part in parts), max(part.most for part in parts)
        return cls(counts=counts, beyond=beyond, most=most)

    def percentile(self, share: float) -> float:
        """Return the lateness [s] that `share` percent of the wake-ups do not exceed."""
        total = self.counts.sum() + self.beyond
        at = int(np.searchsorted(np.cumsum(self.counts), share / 100 * total))
        return at * 1e-6 if at < len(self.counts) else self.most

    def row(self) -> dict[str, Any]:
        """Return its numbers as a row of `--json`."""
        p50, p99, p999 = (self.percentile(share) for share in PERCENTILES)
        inside = self.counts.sum()
        mean = float(np.arange(len(self.counts)) @ self.counts) / max(1, inside) * 1e-6
        return {
            "program": "cyclictest",
            "wakeups": int(inside + self.beyond),
            "mean_s": mean,
            "p50_s": p50,
            "p99_s": p99,
            "p99_9_s": p999,
            "most_s": self.most,
            "skipped": None,
        }

    def __repr__(self) -> str:
        """Return one line: wake-ups and lateness."""
        row = self.row()
        return (
            f"<Cyclictest: {row['wakeups']} wake-ups; late by {1e6 * row['p50_s']:.3g} us (median), "
            f"{1e6 * row['p99_s']:.3g} us (99 %), {1e6 * row['most_s']:.3g} us at most; histogram in .counts>"
        )


def measure(
    *,
    seconds: float = 10.0,
    rate: float = 1000.0,
    mode: Mode = "auto",
    options: _core.RealTime | None = None,
) -> Jitter:
    """Measure how late a thread wakes for its ticks.

    Parameters
    ----------
    seconds : float
        How long [s], above 0, at most 86400.
    rate : float
        Ticks a second [Hz], 10 to 100000.
    mode : "auto", "enforce" or "off"
        Take what the system grants; insist on all of it; ask for nothing.
    options : RealTime, optional
        What the thread asks for.

    Raises
    ------
    ValueError
        For a time, a rate or a mode that cannot be.
    RuntimeError
        With "enforce", when something was not granted: what, why, and the command that would grant it.
    """
    if not 0 < number("seconds", seconds) <= LONGEST:
        raise ValueError(f"seconds = {seconds:g} s: must lie in (0, {LONGEST:g}] s")
    if not 10 <= number("rate", rate) <= 1e5:
        raise ValueError(f"rate = {rate:g} Hz: must lie in [10, 100000] Hz")
    lateness, skipped, grants = _core._measure_jitter(
        1 / rate,
        max(2, round(seconds * rate)),
        mode_named(mode),
        options or _core.RealTime(),
    )
    return Jitter(lateness=lateness, dt=1 / rate, skipped=skipped, grants=grants)


def beside_cyclictest(
    *,
    seconds: float = 10.0,
    rate: float = 1000.0,
    mode: Mode = "auto",
    options: _core.RealTime | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Jitter, Cyclictest | None]:
    """Measure both programs in turns of at most 2 s: occasional load of the machine affects both.

    Parameters
    ----------
    seconds, rate, mode, options
        As `measure`, for each of the two.
    progress : callable, optional
        Called with how many turns are over, and of how many.

    Returns
    -------
    tuple
        What was found; the same of `cyclictest` with what the thread was granted, None where it is not installed or
        not allowed to run.

    Raises
    ------
    ValueError, RuntimeError
        As `measure`.
    """
    wanted = options or _core.RealTime()
    seconds = number("seconds", seconds)
    turns = max(1, ceil(seconds / _TURN)) if 0 < seconds <= LONGEST else 1
    own: list[Jitter] = []
    others: list[Cyclictest] = []
    for turn in range(turns):
        own.append(measure(seconds=seconds / turns, rate=rate, mode=mode, options=wanted))
        fifo = any(grant.name == "priority" and grant.granted for grant in own[-1].grants)
        priority = wanted.priority if fifo else None
        other = cyclictest(seconds=seconds / turns, rate=rate, priority=priority)
        others += [] if other is None else [other]
        if progress is not None:
            progress(turn + 1, turns)
    whole = Cyclictest.pooled(others) if len(others) == turns else None
    return Jitter.pooled(own), whole


#: Lateness that `cyclictest` counts one by one [us].
_LONGEST = 20_000


def cyclictest(
    *, seconds: float, rate: float, priority: int | None, program: str | None = None
) -> Cyclictest | None:
    """Run `cyclictest`; None when it is not installed or is not allowed to run.

    Parameters
    ----------
    seconds, rate : float
        How long [s], and ticks a second [Hz].
    priority : int or None
        Priority under SCHED_FIFO with locked memory; None for an ordinary thread.
    program : str, optional
        Its path; default: where the shell finds it.
    """
    program = program or shutil.which("cyclictest") or shutil.which("cyclictest", path="/usr/sbin")
    if program is None:
        return None
    command = [program, "-q", "-t1", f"-i{round(1e6 / rate)}", f"-l{max(2, round(seconds * rate))}"]
    command += [f"-h{_LONGEST}"]
    command += ["--policy=other"] if priority is None else [f"-p{priority}", "-m"]
    run = subprocess.run(
        command, capture_output=True, text=True, check=False, timeout=3 * seconds + 60
    )
    return None if run.returncode else parse_cyclictest(run.stdout)


def parse_cyclictest(text: str) -> Cyclictest | None:
    """Parse a histogram of `cyclictest -h`; None when there is none."""
    bins = re.findall(r"^(\d{6}) (\d+)", text, re.MULTILINE)
    if not bins:
        return None
    counts = np.zeros(int(bins[-1][0]) + 1, np.int64)
    for lateness, count in bins:
        counts[int(lateness)] = int(count)
    beyond = re.search(r"^# Histogram Overflows: *(\d+)", text, re.MULTILINE)
    most = re.search(r"^# Max Latencies: *(\d+)", text, re.MULTILINE)
    return Cyclictest(
        counts=counts,
        beyond=int(beyond[1]) if beyond else 0,
        most=(int(most[1]) if most else len(counts) - 1) * 1e-6,
    )
