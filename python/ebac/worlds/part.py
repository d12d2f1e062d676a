"""What all parts of a world have in common."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number, shown


class Part:
    """Something of a world that is written to TOML by its fields."""

    def as_dict(self) -> dict[str, Any]:
        """Return the parameters by name, without those that are None."""
        values = {one.name: getattr(self, one.name) for one in fields(self)}  # type: ignore[arg-type]
        return {name: value for name, value in values.items() if value is not None}


def keep(part: Any, **values: float | None) -> None:
    """Keep checked numbers in a frozen part as plain ones: NumPy's are not written to TOML."""
    for name, value in values.items():
        object.__setattr__(part, name, value)


def three(name: str, given: Any, unit: str, most: float) -> tuple[float, float, float]:
    """Return three numbers of a vector, each at most `most` in size."""
    refusal = f"{name} = {given!r} {unit}: must be three numbers in [-{most:g}, {most:g}] {unit}"
    try:
        numbers = [number(name, one) for one in given]
    except TypeError:
        raise TypeError(refusal) from None
    if len(numbers) != 3 or not all(abs(one) <= most for one in numbers):
        raise ValueError(refusal)
    x, y, z = numbers
    return x, y, z


def array(name: str, given: Any, wanted: str) -> NDArray[np.float64]:
    """Return an array of numbers; `wanted` names what it must be."""
    try:
        values = np.asarray(given)
    except ValueError:  # rows of several lengths
        values = np.empty(0, object)
    if values.dtype.kind not in "iuf":
        raise TypeError(f"{name} = {shown(given)}: must be {wanted}")
    return values.astype(float)


def points(name: str, given: Any) -> NDArray[np.float64]:
    """Return an array of points or vectors, shape (n, 3)."""
    values = array(name, given, "numbers, shape (n, 3)")
    if values.ndim != 2 or values.shape[1] != 3:
        raise ValueError(f"{name}: shape {values.shape}: must be (n, 3)")
    return values
