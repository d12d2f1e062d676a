"""Refuse wrong arguments with a sentence that names what is taken."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Sequence
from functools import wraps
from typing import Any, TypeVar

Class = TypeVar("Class", bound=type)


def require(value: Any, types: type | tuple[type, ...], function: str, wanted: str) -> None:
    """Raise TypeError unless a value is of one of the types; `wanted` names it for people."""
    if not isinstance(value, types):
        raise TypeError(f"{function} takes {wanted}, not {shown(value)}")


def keywords_only(
    names: Sequence[str], hint: Callable[[str], str] = lambda name: ""
) -> Callable[[Class], Class]:
    """Decorate a class whose constructor takes only these keywords.

    Parameters
    ----------
    names : sequence of str
        What the constructor takes.
    hint : function
        Returns where an unknown name belongs, or nothing.
    """

    def decorate(cls: Class) -> Class:
        construct: Any = getattr(cls, "__init__")  # noqa: B009

        @wraps(construct)
        def by_name(self: Any, *values: Any, **given: Any) -> None:
            if values:
                raise TypeError(
                    f"{cls.__name__} takes its parameters by name, not {shown(values[0])}; "
                    f"it has: {', '.join(names)}"
                )
            refuse_unknown(cls.__name__, given, names, hint)
            construct(self, **given)

        setattr(cls, "__init__", by_name)  # noqa: B010
        return cls

    return decorate


def unknown_name(what: str, name: str, known: Iterable[str]) -> KeyError:
    """Return the error for a name that does not exist, with the nearest that does."""
    names = list(known)
    lower = {other.lower(): other for other in names}
    near = difflib.get_close_matches(str(name).lower(), lower, 1)
    better = f", did you mean {lower[near[0]]!r}" if near else ""
    return KeyError(f"no {what} is called {name!r}{better}; there are: {', '.join(names)}")


def refuse_unknown(
    what: str,
    given: dict[str, Any],
    names: Sequence[str],
    hint: Callable[[str], str] = lambda name: "",
) -> None:
    """Raise TypeError for a name that is not taken, with a hint or the nearest name."""
    for name in given:
        if name in names:
            continue
        near = difflib.get_close_matches(name, names, 1)
        better = hint(name) or (f"did you mean {near[0]!r}" if near else "")
        more = f", {better}" if better.startswith("did") else f": {better}" if better else ""
        raise TypeError(f"{what} has no parameter {name!r}{more}; it has: {', '.join(names)}")


def shown(value: Any) -> str:
    """Return a value and its type for a message; a long one as its type alone."""
    text = repr(value)
    return f"{text} ({type(value).__name__})" if len(text) <= 60 else type(value).__name__
