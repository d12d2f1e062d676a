"""A solid from a map of heights."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ebac._util.arguments import number
from ebac._util.wrong_calls import plain_constructor
from ebac.worlds.grid import Surface
from ebac.worlds.part import array, keep
from ebac.worlds.triangles import Triangles, check_cell


@plain_constructor
@dataclass(frozen=True)
class HeightField(Triangles):
    """Ground of given heights: solid from `-base` up to them.

    Parameters
    ----------
    heights : array_like, shape (n, m)
        Height along z [m] at n places along x and m along y, 2 at least; the middle lies at the origin.
    spacing : float
        Between two places [m], [1e-4, 1].
    base : float or None
        How far below z = 0 it reaches [m]; None: 10 mm below the lowest place.
    cell : float or None
        Edge of a cell of the grid [m]; None: 1/96 of the longest side.

    Raises
    ------
    TypeError
        When something is no number.
    ValueError
        When a number is out of range.
    ImportError
        Without the extra `worlds`.
    """

    heights: tuple[tuple[float, ...], ...]
    spacing: float = 2e-3
    base: float | None = None
    cell: float | None = None

    def __post_init__(self) -> None:
        """Check the heights."""
        heights = array("HeightField.heights", self.heights, "numbers, shape (n, m)")
        if heights.ndim != 2 or min(heights.shape) < 2:
            raise ValueError(
                f"HeightField.heights: shape {heights.shape}: must be (n, m), 2 at least each"
            )
        wrong = heights[~(np.abs(heights) <= 1)]
        if wrong.size:
            raise ValueError(
                f"HeightField.heights: {wrong[0]:g} m is in it: must all lie in [-1, 1] m"
            )
        spacing = number("HeightField.spacing", self.spacing)
        if not 1e-4 <= spacing <= 1:
            raise ValueError(f"HeightField.spacing = {self.spacing!r} m: must lie in [0.0001, 1] m")
        lowest = -heights.min()
        base = None if self.base is None else number("HeightField.base", self.base)
        if base is not None and not lowest < base <= 10:
            raise ValueError(
                f"HeightField.base = {self.base!r} m: must lie in ({lowest:g}, 10] m, below the lowest place"
            )
        keep(self, spacing=spacing, base=base, cell=check_cell("HeightField", self.cell))
        object.__setattr__(self, "heights", tuple(tuple(map(float, row)) for row in heights))

    @classmethod
    def of(cls, heights: ArrayLike, **more: Any) -> Self:
        """Return it from an array."""
        return cls(
            tuple(map(tuple, array("HeightField.of: heights", heights, "numbers, shape (n, m)"))),
            **more,
        )

    def surface(self) -> Surface:
        """Return the triangles: the ground, four sides and the floor."""
        heights = np.asarray(self.heights)
        n, m = heights.shape
        x, y = np.meshgrid(
            self.spacing * (np.arange(n) - (n - 1) / 2),
            self.spacing * (np.arange(m) - (m - 1) / 2),
            indexing="ij",
        )
        base = 0.01 - heights.min() if self.base is None else self.base
        upper = np.stack([x, y, heights], axis=-1).reshape(-1, 3)
        lower = upper * [1, 1, 0] - [0, 0, base]
        number = np.arange(n * m).reshape(n, m)
        a, b, c, d = (
            one.ravel()
            for one in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
        )
        ground = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
        rim = np.concatenate([number[:-1, 0], number[-1, :-1], number[:0:-1, -1], number[0, :0:-1]])
        after = np.roll(rim, -1)
        below = n * m
        sides = np.concatenate(
            [
                np.column_stack([rim, rim + below, after + below]),
                np.column_stack([rim, after + below, after]),
            ]
        )
        faces = np.concatenate([ground, ground[:, ::-1] + below, sides])
        return Surface(np.concatenate([upper, lower]), faces)
