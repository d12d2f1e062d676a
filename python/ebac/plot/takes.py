"""What a figure is drawn from: anything else is refused by name."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from importlib import import_module
from typing import ParamSpec, TypeVar

from ebac._util.arguments import shown

P = ParamSpec("P")
R = TypeVar("R")


def takes_its_class(module: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorate a function that draws its first argument: it must be of the class that the annotation names.

    The class is that of a module, which is imported when something is drawn: a figure does not import what it draws.
    """

    def decorate(draw: Callable[P, R]) -> Callable[P, R]:
        name, kind = next(iter(draw.__annotations__.items()))

        @wraps(draw)
        def checked(*args: P.args, **kwargs: P.kwargs) -> R:
            if args or name in kwargs:
                given = args[0] if args else kwargs[name]
                if not isinstance(given, getattr(import_module(module), kind)):
                    wanted = f"{'an' if kind[0] in 'AEIO' else 'a'} {kind}"
                    other = shown(given)
                    if type(given).__name__ == kind:  # another class of that name
                        wanted, other = f"{wanted} of {module}", f"one of {type(given).__module__}"
                    raise TypeError(f"ebac.plot.{draw.__name__} takes {wanted}, not {other}")
            return draw(*args, **kwargs)

        return checked

    return decorate
