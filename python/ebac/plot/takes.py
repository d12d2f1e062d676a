"""What a figure is drawn from: anything else is refused by name."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from ebac._util.arguments import shown

P = ParamSpec("P")
R = TypeVar("R")


def takes_its_class(draw: Callable[P, R]) -> Callable[P, R]:
    """Decorate a function that draws its first argument: it must be of the class that the annotation names.

    By name, because a figure does not import what it draws.
    """
    name, kind = next(iter(draw.__annotations__.items()))

    @wraps(draw)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        if args or name in kwargs:
            given = args[0] if args else kwargs[name]
            if kind not in {cls.__name__ for cls in type(given).__mro__}:
                article = "an" if kind[0] in "AEIO" else "a"
                raise TypeError(
                    f"ebac.plot.{draw.__name__} takes {article} {kind}, not {shown(given)}"
                )
        return draw(*args, **kwargs)

    return checked
