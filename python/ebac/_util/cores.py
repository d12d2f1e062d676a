"""The processors at hand."""

from __future__ import annotations

import os

from ebac._util.arguments import whole

#: Most threads that can be asked for.
MOST_THREADS = 1024


def usable_cores() -> int:
    """Return how many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):  # Linux: containers and taskset allow fewer than there are
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def thread_count(threads: int | None) -> int:
    """Return how many threads to use; None: one per usable core.

    Raises
    ------
    TypeError, ValueError
        For what is no whole number, or none in [1, 1024].
    """
    if threads is None:
        return usable_cores()
    if not 1 <= whole("threads", threads) <= MOST_THREADS:
        raise ValueError(
            f"threads = {threads}: must lie in [1, {MOST_THREADS}]; without it there is one per usable core"
        )
    return threads
