"""The border of every law, and the area under it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ebac._core import Wall
from ebac._util.arrays import Values
from ebac.scenario import Scenario

#: The criteria of the search, and what each asks of a press and of a tap.
CRITERIA: dict[str, str] = {
    "still": "no sustained limit cycle: swings by less than 0.25 mm at the end",
    "quiet": "still, and a quiet force, see `Contact`",
    "energy": "takes no more than epsilon out of the port",
    "usable": "quiet, energy, and at least half of the stiffness shown at rest",
}

#: Stiffnesses at which the vibration of the force is shown [N/m], and for how many seeds of the noise.
STIFFNESSES = (2e3, 5e3, 10e3, 20e3)
SEEDS = 5

VIBRATION = "vibration"
#: What ends a usable border, by the criterion that ends at the same stiffness.
ENDS: dict[str, str] = {"still": "limit cycle", "quiet": VIBRATION, "energy": "energy"}
#: The same where the search ends first, and where none of these does: less than half of the stiffness is shown.
AT_TOP, TOO_SOFT = "top", "too soft"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ZWidth:
    """For every law, delay and wall damping the largest stiffness up to which a criterion holds.

    Attributes
    ----------
    base : Scenario
        What was simulated, but for wall, delay and approach.
    laws : tuple of str
        Names.
    delays : tuple of int
        Samples.
    dampings : array, shape (m,)
        Wall damping B [N s/m].
    least_stiffness, most_stiffness : float
        Ends of the search [N/m]: a limit of `most_stiffness` means "at least"; below `least_stiffness` it is 0.
    epsilon : float
        Energy that a hand may draw [J].
    hands : int
        Random hands of each family for which the energy criterion must hold as well.
    limits : dict of str to array, shape (laws, delays, m)
        Largest stiffness [N/m] by criterion, see `CRITERIA`.
    spectral : array, shape (delays, m)
        The same for the linear loop without a law: spectral radius below one; NaN for a device that is not linear.
    vibration : array, shape (laws, delays, len(STIFFNESSES), SEEDS)
        Vibration of the force [detection thresholds], the larger of press and tap, at each of `STIFFNESSES` and the
        wall damping of `base`, with the seeds from that of `base` up; quiet is below 3. NaN where a run has none, as
        one that ends early. It shows how near a law is to its border, and how far the noise moves it.
    """

    base: Scenario
    laws: tuple[str, ...]
    delays: tuple[int, ...]
    dampings: Values
    least_stiffness: float
    most_stiffness: float
    epsilon: float
    hands: int
    limits: dict[str, Values]
    spectral: Values
    vibration: Values

    @property
    def random_hands(self) -> str:
        """How many random hands of all families there were, as "210 random hands"; empty for none."""
        from ebac._util.plural import plural
        from ebac.studies.families import PULL, families

        return plural(self.hands * len(families(PULL)), "random hand") if self.hands else ""

    def area(self, criterion: str, law: str, delay: int) -> float:
        """Return the score: the area under the border, both axes linear, stiffness up to `most_stiffness` [N/m N s/m].

        Parameters
        ----------
        criterion : str
            A name of `CRITERIA`, or "spectral", the same for every law.
        law, delay
            Which border.
        """
        d = self.delays.index(delay)
        border = (
            self.spectral[d]
            if criterion == "spectral"
            else self.limits[criterion][self.laws.index(law), d]
        )
        return float(np.trapezoid(np.minimum(border, self.most_stiffness), self.dampings))

    def share(self, law: str, delay: int) -> float:
        """Return the usable part of all walls up to `most_stiffness`, 0 to 1; of one damping, that of its walls."""
        width = float(self.dampings[-1] - self.dampings[0])
        if width == 0:
            limit = self.limits["usable"][self.laws.index(law), self.delays.index(delay), 0]
            return float(limit) / self.most_stiffness
        return self.area("usable", law, delay) / (self.most_stiffness * width)

    def ended_by(self, law: str, delay: int) -> list[str]:
        """Return what the walls above the usable border are lost by, for each wall damping.

        "limit cycle", "vibration" of the force, "energy" given out, "too soft" (less than half of the stiffness is
        shown at rest), or "top": the search ended first. Where two criteria end together, the first of these.
        """
        i, d = self.laws.index(law), self.delays.index(delay)
        limits = {name: self.limits[name][i, d] for name in CRITERIA}

        def of(j: int) -> str:
            usable = limits["usable"][j]
            if usable >= self.most_stiffness:
                return AT_TOP
            met = (word for name, word in ENDS.items() if limits[name][j] <= usable * (1 + 1e-9))
            return next(met, TOO_SOFT)

        return [of(j) for j in range(len(self.dampings))]

    def scores(self) -> list[dict[str, Any]]:
        """Return one row per law and delay: areas by criterion, how many times those of `direct`, usable share."""
        rows = []
        for law in self.laws:
            for delay in self.delays:
                row: dict[str, Any] = {"law": law, "delay_samples": delay}
                for name in CRITERIA:
                    area = self.area(name, law, delay)
                    row[f"{name}_area"] = area
                    own = self.area(name, "direct", delay) if "direct" in self.laws else 0.0
                    row[f"{name}_times_direct"] = area / own if own > 0 else None
                row["usable_share"] = self.share(law, delay)
                rows.append(row)
        return rows

    def vibrations(self) -> list[dict[str, Any]]:
        """Return one row per law, delay and stiffness: least and largest vibration over the seeds [thresholds]."""
        wall = self.base.environment
        return [
            {
                "law": law,
                "delay_samples": delay,
                "damping_Ns_per_m": wall.damping if isinstance(wall, Wall) else None,
                "stiffness_N_per_m": stiffness,
                "perceived_least": _number(self.vibration[i, d, k].min()),
                "perceived_largest": _number(self.vibration[i, d, k].max()),
            }
            for i, law in enumerate(self.laws)
            for d, delay in enumerate(self.delays)
            for k, stiffness in enumerate(STIFFNESSES)
        ]

    def __repr__(self) -> str:
        """Return the stiffest wall of each law by criterion, its mean over the wall damping."""
        from ebac._util.report import report

        return report(self._title(), self._means(), self._note())

    def _repr_html_(self) -> str:
        """Return the same and the figure, for a notebook."""
        from ebac._util import notebook
        from ebac.plot import plot_zwidth

        title = f"{self._title()}. {self._note()}".removesuffix(". ")
        return notebook.result(title, self._means(), lambda: plot_zwidth(self))

    def _title(self) -> str:
        from ebac._util.plural import plural

        return (
            f"Z-width, simulated: {plural(len(self.laws), 'law')}, {plural(len(self.delays), 'delay')}; "
            f"stiffest wall, mean over wall damping {self.dampings[0]:g} to {self.dampings[-1]:g} N s/m"
        )

    def _means(self) -> list[dict[str, Any]]:
        """Return one row per law and delay: by criterion the stiffest wall, its mean over the wall damping."""
        from ebac._util.formatting import or_more

        width = float(self.dampings[-1] - self.dampings[0])
        return [
            {
                "law": law,
                "delay_samples": delay,
                **{
                    f"{name}_N_per_m": or_more(
                        self.area(name, law, delay) / width,
                        "N/m",
                        ended=bool((self.limits[name][i, d] >= self.most_stiffness).any()),
                    )
                    for name in CRITERIA
                },
            }
            for i, law in enumerate(self.laws)
            for d, delay in enumerate(self.delays)
        ]

    def _note(self) -> str:
        failing = any((limits == 0).any() for limits in self.limits.values())
        return "A wall damping at which a law holds no wall counts as 0 N/m." if failing else ""

    def rows(self) -> list[dict[str, Any]]:
        """Return one row per law, delay and wall damping, SI units, the unit in the name."""
        from ebac.studies.zwidth.ceilings import delay_ceiling, passive_ceiling

        device, hand = self.base.device, self.base.hand
        timings = [self.base.timing.replace(delay=delay) for delay in self.delays]
        return [
            {
                "law": law,
                "delay_samples": delay,
                "damping_Ns_per_m": float(damping),
                "passive_N_per_m": passive_ceiling(device, timings[d], float(damping)),
                "delay_ceiling_N_per_m": delay_ceiling(device, timings[d], float(damping), hand),
                "spectral_N_per_m": float(self.spectral[d, j]),
                **{
                    f"{name}_N_per_m": float(limits[i, d, j])
                    for name, limits in self.limits.items()
                },
                "usable_ended_by": ended,
            }
            for i, law in enumerate(self.laws)
            for d, delay in enumerate(self.delays)
            for j, (damping, ended) in enumerate(
                zip(self.dampings, self.ended_by(law, delay), strict=True)
            )
        ]


def _number(value: float) -> float | None:
    """Return a number, None for one that does not exist."""
    return None if np.isnan(value) else float(value)
