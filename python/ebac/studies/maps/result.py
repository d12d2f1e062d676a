"""A map and its score."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number, require_path
from ebac._util.arrays import Values
from ebac._util.atomic_file import draft
from ebac.scenario import Scenario
from ebac.studies.maps.axes import AXES, MapAxis
from ebac.studies.sweeps import SweepResult

#: What a run can come to, best first: a cell of `verdict` is a place in this list.
VERDICTS = ("exact and quiet", "exact, force not quiet", "still, not exact", "swings", "diverges")
#: The same in a map without an ideal rest, where the target of the hand or the wall may move the handle.
UNJUDGED = ("quiet", "still, force not quiet", "swings, or is moved", "diverges")


@dataclass(frozen=True, kw_only=True, eq=False)
class StabilityMap:
    """One law over a grid: `map["swing_m"]` is an array, row by row along y, column by column along x.

    Attributes
    ----------
    base : Scenario
        What was simulated, but for the two quantities.
    law : str
        Its name.
    x, y : str
        Names of `AXES`.
    xs, ys : array
        Values along the axes.
    result : SweepResult
        Every number of every run, y by y, x after x.
    """

    base: Scenario
    law: str
    x: str
    y: str
    xs: Values
    ys: Values
    result: SweepResult

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Return a number of the sweep as a grid, shape (len(ys), len(xs))."""
        return self.result[name].reshape(len(self.ys), len(self.xs))

    @property
    def axes(self) -> tuple[MapAxis, MapAxis]:
        """The quantities along x and y."""
        return AXES[self.x], AXES[self.y]

    @property
    def quiet(self) -> NDArray[np.bool_]:
        """Where the run came to its end and its contact is quiet."""
        return np.asarray(self["quiet"])

    @cached_property
    def unjudged(self) -> str:
        """Why no run is judged exact: some run has no ideal rest; empty where all have one."""
        from ebac.metrics.unjudged import no_ideal_rest

        unknown = np.argwhere(~np.isfinite(self["ideal_m"]))
        if not len(unknown):
            return ""
        row, column = unknown[0]
        along, up = self.axes
        return no_ideal_rest(up.apply(along.apply(self.base, self.xs[column]), self.ys[row]))

    @property
    def verdicts(self) -> tuple[str, ...]:
        """What a run of this map can come to, best first: `VERDICTS`, or `UNJUDGED` without an ideal rest."""
        return UNJUDGED if self.unjudged else VERDICTS

    @property
    def verdict(self) -> NDArray[np.int64]:
        """What each run came to: the place in `verdicts`."""
        of_still = np.where(self.quiet, 0, 1)
        if not self.unjudged:
            exact = self.result.exact.reshape(self.quiet.shape)
            of_still = np.where(exact, of_still, VERDICTS.index("still, not exact"))
        swings, diverges = len(self.verdicts) - 2, len(self.verdicts) - 1
        return np.where(self._lost, diverges, np.where(self["still"], of_still, swings))

    @property
    def _lost(self) -> NDArray[np.bool_]:
        return np.asarray(self["diverged"] | (self["fault"] != 0) | ~self["done"])

    def scores(self, epsilon: float = 1e-3) -> dict[str, float | None]:
        """Return the share of the area, as the axes are drawn, where a criterion holds; None where it is not judged.

        Parameters
        ----------
        epsilon : float
            Energy [J] that a hand may draw, at least 0.

        Raises
        ------
        ValueError
            For less.
        """
        if not number("epsilon", epsilon) >= 0:
            raise ValueError(f"epsilon = {epsilon} J: must be at least 0")
        energy = (self["least_energy_J"] >= -epsilon) & ~self._lost
        return {
            "quiet_share": float(self.quiet.mean()),
            "exact_share": None if self.unjudged else float((self.verdict == 0).mean()),
            "energy_share": float(energy.mean()),
            "quiet_and_energy_share": float((self.quiet & energy).mean()),
        }

    def to_npz(self, path: str | Path) -> None:
        """Write axes and all numbers as arrays; `.npz` is added to a name that does not end in it.

        Raises
        ------
        OSError
            When the file cannot be written; one of that name stays as it is.
        """
        require_path(path, "StabilityMap.to_npz")
        arrays: dict[str, Any] = {self.x: self.xs, self.y: self.ys}
        arrays |= {name: self[name] for name in self.result if name != "law"}
        whole = path if str(path).endswith(".npz") else f"{path}.npz"
        with draft(whole) as name, name.open("wb") as file:
            np.savez_compressed(file, **arrays)

    def _repr_html_(self) -> str:
        """Return the figure and the scores, for a notebook."""
        from ebac._util import notebook
        from ebac.plot import plot_map

        return notebook.result(repr(self), [self.scores()], lambda: plot_map(self))

    def __repr__(self) -> str:
        """Return the quantities, their ranges and the shares of the area."""
        from ebac._util.formatting import quantity

        along, up = self.axes
        why = f"; no ideal rest: {self.unjudged}" if self.unjudged else ""
        shares = ", ".join(
            f"{name.removesuffix('_share').replace('_', ' ')} {quantity(value, 'share', none='not judged')}"
            for name, value in self.scores().items()
        )
        return (
            f"<StabilityMap of {self.law}, simulated, {len(self.xs)} x {len(self.ys)} runs: "
            f"{_range(along, self.xs)}, {_range(up, self.ys)}; "
            f"of the area {shares}{why}>"
        )


def _range(axis: MapAxis, values: Values) -> str:
    return f"{axis.name} {axis.plain_symbol} [{axis.unit}] {values[0]:g} to {values[-1]:g}"
