"""What `stiffest` found: for each law the stiffest wall that it holds, and what hands do there."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac._util import row_files
from ebac._util.arguments import named, require_path
from ebac.scenario import Scenario
from ebac.studies.result import Study

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: The criteria, each stricter than the one before, and what each asks of a hand.
CRITERIA = {
    "exact_and_still": "rests where it rests at the ideal wall, and does not swing",
    "good": "exact and still, and the force is quiet, too",
    "good_in_time": "good, and settled within 1.5 times the time of the ideal wall, plus 0.2 s",
}
#: The hands that are asked for may be missed by so little, as 0.95 of 60 is 57.00000000000001 [hands].
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True)
class StiffestRow:
    """The stiffest walls of one law; None where already the softest wall of the ladder fails.

    Attributes
    ----------
    law : str
        Its name.
    exact_and_still_N_per_m, good_N_per_m, good_in_time_N_per_m : float or None
        Stiffest wall up to which every wall of the ladder holds, by each of `CRITERIA`.
    exact_and_still_drawn_J, good_drawn_J, good_in_time_drawn_J : float or None
        Most energy that any hand draws in any window at that wall, see `Contact`; hands beyond `share` count, too.
    exact_and_still_settled_s, good_settled_s, good_in_time_settled_s : float or None
        Median settling time at that wall, of the hands that settle.
    exact_and_still_impact_share, good_impact_share, good_in_time_impact_share : float or None
        Median stiffness on impact at that wall: the force where a hand goes deepest, over that of the wall there.
    """

    law: str
    exact_and_still_N_per_m: float | None
    exact_and_still_drawn_J: float | None
    exact_and_still_settled_s: float | None
    exact_and_still_impact_share: float | None
    good_N_per_m: float | None
    good_drawn_J: float | None
    good_settled_s: float | None
    good_impact_share: float | None
    good_in_time_N_per_m: float | None
    good_in_time_drawn_J: float | None
    good_in_time_settled_s: float | None
    good_in_time_impact_share: float | None

    def row(self) -> dict[str, Any]:
        """Return the documented row of `ebac stiffest --json`."""
        return asdict(self)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Stiffest:
    """For each law the stiffest wall up to which it holds for all hands, or for a share of them.

    Attributes
    ----------
    study : Study
        Every run: laws x walls x hands, the condition `K10` being the wall of 10 kN/m.
    base : Scenario
        What was simulated, but for the hand and the stiffness of the wall.
    stiffnesses : array, shape (walls,)
        Stiffness of the walls, softest first [N/m].
    share : float
        Share of the hands for which a wall must hold, (0, 1].
    counts : dict of str to array, shape (laws, walls)
        Hands that meet each of `CRITERIA`; no `good_in_time` where the time at the ideal wall is not known, as on a
        gimbal.
    """

    study: Study
    base: Scenario
    stiffnesses: NDArray[np.float64]
    share: float
    counts: dict[str, NDArray[np.int64]]

    @property
    def hands(self) -> int:
        """The number of hands."""
        return len(self.study.operators)

    @property
    def needed(self) -> int:
        """The number of hands for which a wall must hold."""
        return ceil(self.share * self.hands - _ROUNDING)

    @property
    def not_good(self) -> NDArray[np.int64]:
        """Hands that are not good, shape (laws, walls)."""
        return self.hands - self.counts["good"]

    @property
    def late(self) -> NDArray[np.int64] | None:
        """Hands that are good, but late, shape (laws, walls); None where the time at the ideal wall is not known."""
        in_time = self.counts.get("good_in_time")
        return None if in_time is None else self.counts["good"] - in_time

    def holds(self, criterion: str) -> NDArray[np.bool_]:
        """Return where enough hands meet one of `CRITERIA`, shape (laws, walls); False where it is not known.

        Raises
        ------
        KeyError
            For a criterion that does not exist.
        """
        named("criterion", criterion, CRITERIA)
        if criterion not in self.counts:
            return np.zeros((len(self.study.laws), len(self.stiffnesses)), bool)
        return np.asarray(self.counts[criterion] >= self.needed)

    def again(self, criterion: str) -> dict[str, list[float]]:
        """Return for each law the walls that hold though a softer one fails, by stiffness [N/m]; most have none."""
        holds = self.holds(criterion)
        beyond = holds & ~np.logical_and.accumulate(holds, axis=1)
        return {
            law: self.stiffnesses[walls].tolist()
            for law, walls in zip(self.study.laws, beyond, strict=True)
        }

    @cached_property
    def rows(self) -> list[StiffestRow]:
        """One row per law, best first: by the wall that is good, then in time, then exact, then by the energy."""
        found = [self._row(i, law) for i, law in enumerate(self.study.laws)]
        return sorted(found, key=_rank)

    def _row(self, i: int, law: str) -> StiffestRow:
        values: dict[str, float | None] = {}
        for criterion in CRITERIA:
            walls = int(np.logical_and.accumulate(self.holds(criterion)[i]).sum())
            at = self._walls[i][walls - 1] if walls else {}
            values |= {
                f"{criterion}_N_per_m": at.get("stiffness_N_per_m"),
                f"{criterion}_drawn_J": at.get("most_drawn_J"),
                f"{criterion}_settled_s": at.get("median_settled_s"),
                f"{criterion}_impact_share": at.get("median_impact_share"),
            }
        return StiffestRow(law=law, **values)

    def walls(self) -> list[dict[str, Any]]:
        """Return one row per law and wall: hands that meet each criterion, energy, settling, impact; SI units."""
        return [row for rows in self._walls for row in rows]

    @cached_property
    def _walls(self) -> list[list[dict[str, Any]]]:
        laws = list(self.study.laws)
        return [
            [
                {
                    "law": law,
                    "stiffness_N_per_m": float(stiffness),
                    "hands": self.hands,
                    **{
                        name: int(self.counts[name][i, k]) if name in self.counts else None
                        for name in CRITERIA
                    },
                    "most_drawn_J": row.most_drawn_J,
                    "median_settled_s": row.median_settled_s,
                    "median_impact_share": row.median_impact_share,
                }
                for k, stiffness in enumerate(self.stiffnesses)
                for row in [self.study.rows[k * len(laws) + i]]
            ]
            for i, law in enumerate(laws)
        ]

    def __repr__(self) -> str:
        """Return a row per law, the best first."""
        from ebac._util.report import report

        return report(self._title(), self._shown(), keys=("law",))

    def _repr_html_(self) -> str:
        """Return the figure and a row per law, for a notebook."""
        from ebac._util import notebook

        return notebook.result(self._title(), self._shown(), self.plot)

    def _title(self) -> str:
        of = f"{self.needed} of {self.hands} hands"
        ends = f"{1e-3 * self.stiffnesses[0]:g} to {1e-3 * self.stiffnesses[-1]:g} kN/m"
        return f"Stiffest wall up to which {of} are held, simulated; {len(self.stiffnesses)} walls, {ends}"

    def _shown(self) -> list[dict[str, Any]]:
        """Return the rows with "or more" at the stiffest wall that was tried."""
        from ebac._util.formatting import or_more

        top = float(self.stiffnesses[-1])
        keys = [f"{criterion}_N_per_m" for criterion in CRITERIA]
        return [
            row | {key: or_more(row[key], "N/m", ended=row[key] == top) for key in keys}
            for row in self._table()
        ]

    def _table(self) -> list[dict[str, Any]]:
        return [row.row() for row in self.rows]

    def plot(self) -> Figure:
        """Draw the share of the hands that meet each criterion over the stiffness, a panel for each law."""
        from ebac.plot import plot_stiffest

        return plot_stiffest(self)

    def to_json(self) -> str:
        """Return the JSON document of `ebac stiffest --json`: a row per law, SI units.

        To the attributes of `StiffestRow` come the lists `not_good` and `late`, a number of hands per wall.
        """
        laws, late = list(self.study.laws), self.late
        rows = [
            row.row()
            | {
                "not_good": self.not_good[i].tolist(),
                "late": None if late is None else late[i].tolist(),
            }
            for row in self.rows
            for i in [laws.index(row.law)]
        ]
        return row_files.document(
            "stiffest", rows, hands=self.hands, share=self.share,
            stiffnesses_N_per_m=self.stiffnesses.tolist(), walls=self.walls(),
        )  # fmt: skip

    def save(self, path: str | Path) -> None:
        """Write a row per law, the format by the extension: .json as `to_json`, or .csv. A file there is replaced.

        Raises
        ------
        ValueError
            For another extension.
        """
        require_path(path, "Stiffest.save")
        row_files.save(path, self.to_json(), self._table())


def _rank(row: StiffestRow) -> tuple[float, ...]:
    """Return what a row is sorted by, least first."""
    walls = (row.good_N_per_m, row.good_in_time_N_per_m, row.exact_and_still_N_per_m)
    drawn = row.exact_and_still_drawn_J if row.good_N_per_m is None else row.good_drawn_J
    return (*(-(wall or 0.0) for wall in walls), drawn or 0.0)
