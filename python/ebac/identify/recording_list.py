"""Recordings as functions take them: one or several, of one name each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from ebac._util.arguments import require
from ebac.identify.recording import Recording


def with_own_names(recordings: Sequence[Recording]) -> list[Recording]:
    """Return recordings of which no two have one name: a name that comes again has the number of its log behind it."""
    names = [r.name for r in recordings]
    return [
        replace(r, name=f"{r.name} (log {i})") if names.count(r.name) > 1 else r
        for i, r in enumerate(recordings, 1)
    ]


def refuse_copies(recordings: Sequence[Recording], names: Sequence[object]) -> None:
    """Raise ValueError where two recordings hold the same rows: they would count as two, and narrow the intervals."""
    every = [(name, r.channels()) for name, r in zip(names, recordings, strict=True)]
    for (first, a), (second, b) in combinations(every, 2):
        if a.keys() == b.keys() and all(np.array_equal(a[key], b[key]) for key in a):
            raise ValueError(f"{second}: holds the same rows as {first}; give each log once")


def require_recordings(
    value: object, function: str, *, several: bool = False, rotary: bool = False
) -> None:
    """Raise TypeError unless a value is a Recording, or `several`; ValueError for a rotary one unless allowed.

    The message names the `function` that was called.
    """
    for one in value if several and isinstance(value, (list, tuple)) else [value]:
        require(
            one,
            Recording,
            f"ebac.identify.{function}",
            "a Recording, as ebac.identify.load returns it",
        )
        if isinstance(one, Recording) and one.rotary and not rotary:
            raise ValueError(
                f"{one.name}: is of a rotary device, in rad and N m; eq. (4) is of a hand at a handle. "
                "Give the radius at which it holds [m]: lever=0.05, --lever 0.05 or recording.at_lever(0.05)"
            )
