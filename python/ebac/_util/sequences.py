"""Refuse what is no sequence of what is taken, with a sentence that names it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ebac._util.arguments import number, require, shown


def require_each(values: Any, types: type | tuple[type, ...], function: str, wanted: str) -> None:
    """Raise TypeError unless values are a sequence, of values of one of the types; `wanted` names it for people."""
    require(values, Sequence, function, wanted)
    for value in values:
        require(value, types, function, wanted)


def several(name: str, values: Any, *, least: int = 1) -> list[Any]:
    """Return a list of values, at least one; none may be given where `least` is 0.

    Raises
    ------
    TypeError, ValueError
        For what is no sequence, and for an empty one; the message names it.
    """
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise TypeError(f"{name} = {shown(values)}: must be a sequence, such as [{values!r}]")
    every = list(values)
    if len(every) < least:
        raise ValueError(f"{name} = {every}: is empty; give one at least")
    return every


def several_numbers(name: str, values: Any) -> list[float]:
    """Return a list of numbers, at least one.

    Raises
    ------
    TypeError, ValueError
        As by `several`, and for one that is no number; the message names it.
    """
    return [number(name, value) for value in several(name, values)]


def each_once(name: str, values: Any, unit: str = "") -> list[Any]:
    """Return a list of values as of `several`, each of which stands there once: a second row would hide the first.

    Raises
    ------
    TypeError, ValueError
        As by `several`, and for a value that stands there twice.
    """
    every = several(name, values)
    unit = unit and f" {unit}"
    for place, one in enumerate(every):
        if one in every[:place]:
            raise ValueError(
                f"{name} = {every}{unit}: {one!r}{unit} stands there twice; give each once"
            )
    return every
