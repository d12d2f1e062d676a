"""A law in Python under a run: what it raises is kept for the end, where it is named."""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, cast

from ebac._util.arguments import did_you_mean

if TYPE_CHECKING:
    from ebac._core import Port
    from ebac.laws import PythonLaw

#: What people call the fields of a port.
_MEANT = {
    "force": ("f_meas", "f_env"),
    "position": ("x",),
    "velocity": ("v",),
}


class KeptLaw:
    """A law in Python as the core calls it: its first error is kept for the end of the run.

    Parameters
    ----------
    law : PythonLaw
        The law.
    errors : list
        Where its first error goes; copies share it.
    """

    def __init__(self, law: PythonLaw, errors: list[BaseException]) -> None:
        self._law, self._errors = law, errors
        self.observer = bool(getattr(law, "observer", False))

    def step(self, port: Port) -> float:
        """Return the force [N]; NaN after an error."""
        __tracebackhide__ = True  # a failed test shows the law
        if self._errors:
            return math.nan
        try:
            return self._number(self._law.step(port))
        except BaseException as error:
            if isinstance(error, AttributeError) and error.obj is port:
                error.args = (_no_field(port, str(error.name)),)
            self._errors.append(error)
            return math.nan

    def _number(self, answer: Any) -> float:
        try:
            math.isnan(answer)  # takes what the core takes
        except Exception:
            step = f"{type(self._law).__name__}.step"
            raise TypeError(
                f"{step} returned {answer!r}: must return the force [N] of one axis, a number"
            ) from None
        return cast(float, answer)

    def reset(self) -> None:
        """Forget everything but the parameters."""
        try:
            self._law.reset()
        except BaseException as error:
            self._errors.append(error)

    def __deepcopy__(self, memo: dict[int, Any]) -> KeptLaw:
        """Return one with a copy of the law."""
        return KeptLaw(copy.deepcopy(self._law, memo), self._errors)


def _no_field(port: Port, name: str) -> str:
    """Return what a port has in place of a field that it has not."""
    known = [one for one in dir(port) if not one.startswith("_")]
    more = did_you_mean(name, known, _MEANT.get(name, ()))
    return f"a port has no {name!r}{more}; it has: {', '.join(known)}"


def law_error(errors: Sequence[BaseException]) -> Exception | None:
    """Return what a law in Python raised in a run; an interrupt is raised again."""
    for error in errors:
        if not isinstance(error, Exception):
            raise error
        return error
    return None
