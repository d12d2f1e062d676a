"""Objects of a user's own of which every run has a deep copy, or a sentence that names what cannot be copied."""

from __future__ import annotations

import copy
from typing import Any


def refuse_uncopyable(given: Any, kind: str) -> None:
    """Raise TypeError for an object that has no deep copy; it names the attribute that has none.

    Parameters
    ----------
    given : object
        Of which runs have copies.
    kind : str
        What it is: "law".
    """
    try:
        copy.deepcopy(given)
    except Exception as error:
        name = type(given).__name__
        named = next((f"{name}.{key}" for key, value in _state(given) if not _copied(value)), name)
        raise TypeError(
            f"{named}: cannot be copied ({error}), and each axis and each run has a deep copy of a {kind}: keep such "
            f"an object outside of the {kind}, as an attribute of the class, or write {name}.__deepcopy__"
        ) from error


def _state(given: Any) -> list[tuple[str, Any]]:
    return list(getattr(given, "__dict__", {}).items())


def _copied(value: Any) -> bool:
    try:
        copy.deepcopy(value)
    except Exception:
        return False
    return True
