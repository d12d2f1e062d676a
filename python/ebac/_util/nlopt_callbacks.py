"""Exceptions carried out of NLopt's callbacks, in which it would lose them."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import Any

from ebac._util.arrays import Values


class Carried:
    """Callbacks of one optimiser: the first exception in any of them stops it, and is raised by `settle`.

    Parameters
    ----------
    optimiser : nlopt.opt
        Whose own exceptions are switched off.
    """

    def __init__(self, optimiser: Any) -> None:
        optimiser.set_exceptions_enabled(False)
        # It holds its callbacks and they this: a circle through C++, which no garbage collector sees.
        self._optimiser = weakref.proxy(optimiser)
        self._raised: BaseException | None = None

    def __call__(
        self, function: Callable[[Values], float], *, instead: float
    ) -> Callable[[Values, Any], float]:
        """Return `function` as NLopt calls it; `instead` is what it gives once something was raised."""
        return self.with_gradient(lambda point, _: function(point), instead=instead)

    def with_gradient(
        self, function: Callable[[Values, Values], float], *, instead: float
    ) -> Callable[[Values, Values], float]:
        """Return the same of a function that also fills a gradient in, where that is not empty."""

        def called(point: Values, gradient: Values) -> float:
            if self._raised is not None:
                return instead
            try:
                return function(point, gradient)
            except BaseException as error:
                self._raised = error
                self._optimiser.force_stop()
                return instead

        return called

    def settle(self) -> None:
        """Raise what was raised in a callback."""
        if self._raised is not None:
            raise self._raised
