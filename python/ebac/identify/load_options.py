"""Options of `load`: those that a file has no use for, and names by signal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

#: Options that not every file has a use for, and why not.
UNUSED = {
    "rate": "the log has times of its own",
    "units": "the log names its units",
    "lever": "the log is of a handle, in m and N",
    "counts_per_turn": "the log is of a handle, in m and N",
    "torque_constant": "the log is of a handle, in m and N",
    "force_constant": "the log is of a handle, in m and N",
    "axis": "the file has one axis; name its columns instead: columns={'x': 'NAME'}",
}


def refuse_unused(name: str, **given: object) -> None:
    """Raise ValueError for an option that is given all the same, with the reason."""
    for option, value in given.items():
        if value is not None:
            raise ValueError(f"{name}: {option} = {value}: {UNUSED[option]}")


def words_by_signal(option: str, given: object) -> dict[str, str]:
    """Return names or units by signal.

    Raises
    ------
    TypeError
        For anything else.
    """
    words: dict[str, Any] = dict(given or {}) if isinstance(given, Mapping | None) else {"": 0}
    if not all(isinstance(word, str) for word in words.values()):
        raise TypeError(f"{option} = {given!r}: must be names by signal, such as {{'x': 'mm'}}")
    return words
