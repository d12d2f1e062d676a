"""What all parts of a world have in common."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np


class Part:
    """Something of a world that is written to TOML by its fields."""

    def as_dict(self) -> dict[str, Any]:
        """Return the parameters by name, without those that are None."""
        values = {one.name: getattr(self, one.name) for one in fields(self)}  # type: ignore[arg-type]
        return {name: value for name, value in values.items() if value is not None}


def three(name: str, given: Any, unit: str, most: float) -> tuple[float, float, float]:
    """Return three numbers of a vector, each at most `most` in size."""
    numbers = np.asarray(given, float)
    if numbers.shape != (3,) or not (np.abs(numbers) <= most).all():
        raise ValueError(
            f"{name} = {given!r} {unit}: must be three numbers in [-{most:g}, {most:g}] {unit}"
        )
    x, y, z = (float(one) for one in numbers)
    return x, y, z
