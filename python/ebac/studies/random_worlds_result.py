"""What `random_worlds` found: a row for each law in each kind of world, and every hand to simulate again."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import require
from ebac.laws import AnyLaw, design
from ebac.laws.tuned_laws import on_its_observer
from ebac.scenario import Scenario
from ebac.studies.hand_search import every_row
from ebac.studies.random_scenario import random_scenario
from ebac.trace import Trace

#: A hand that the guard holds back for longer than this is counted [s].
HELD_BACK = 0.1


@dataclass(frozen=True, kw_only=True)
class RandomWorldRow:
    """The hands of one law in worlds of one kind, with one device, stiffness and delay.

    Attributes
    ----------
    kind, device, law : str
        Names.
    stiffness_N_per_m : float
        Of every surface.
    delay_samples : int
        Until a command acts.
    hands : int
        How many ran.
    touched : int
        How many of them met a body at all.
    held_back : int or None
        Hands that the guard held back for longer than 0.1 s, letting less than half of the command through; None for
        a law without a guard.
    longest_held_back_s : float or None
        The longest such time of all hands: the largest value of the column `law.starved`, which rises in ticks in
        which less than half passes in one direction, and falls ten times faster in others.
    drawn_J : float
        Largest energy drawn by a hand, beyond all that it had put in and what moving surfaces did:
        `ebac.metrics.drawn`.
    reserve_J : float or None
        Reserve of the law, with which its account starts; None for a law without a reserve.
    beyond_reserve : int or None
        Hands that drew more than that; None for a law without a reserve.
    faults : int
        Hands whose run ended by a fault.
    worst_hand : int
        Index of a hand to look at: one with a fault, else the one that was held back longest if that is longer than
        0.1 s, else the one that drew most; of several that drew nothing the one that was held back longest.
    """

    kind: str
    device: str
    stiffness_N_per_m: float
    delay_samples: int
    law: str
    hands: int
    touched: int
    held_back: int | None
    longest_held_back_s: float | None
    drawn_J: float
    reserve_J: float | None
    beyond_reserve: int | None
    faults: int
    worst_hand: int


@dataclass(frozen=True, kw_only=True, repr=False)
class RandomWorlds:
    """What `random_worlds` found.

    Attributes
    ----------
    rows : tuple of RandomWorldRow
        For each kind, device, stiffness and delay: each law.
    moving : bool
        Whether each body swung in a direction of its own.
    noise_N, lag_s : float
        Noise of the force sensor, standard deviation, and the time constant of its filter.
    seed : int
        Of all hands.
    laws : dict of str to law
        By the names in the rows.
    drawn_J, held_back_s : tuple of array, each of shape (hands,)
        Energy that each hand of a row drew, and the longest time for which it was held back, in the order of `rows`;
        the time is NaN for a law without a guard.
    """

    rows: tuple[RandomWorldRow, ...]
    moving: bool
    noise_N: float
    lag_s: float
    seed: int
    laws: dict[str, AnyLaw]
    drawn_J: tuple[NDArray[np.float64], ...] = field(compare=False)
    held_back_s: tuple[NDArray[np.float64], ...] = field(compare=False)

    def table(self) -> list[dict[str, Any]]:
        """Return the rows as dictionaries, units in the keys."""
        return [asdict(row) for row in self.rows]

    def totals(self) -> list[RandomWorldRow]:
        """Return all rows of a law as one, for each law; kind, device, stiffness and delay are those of its worst.

        A hand counts once for each stiffness and delay that it met.
        """
        of_law: dict[str, list[int]] = {}
        for i, row in enumerate(self.rows):
            of_law.setdefault(row.law, []).append(i)
        return [
            _together([self.rows[i] for i in those], self.rows[max(those, key=self._rank)])
            for those in of_law.values()
        ]

    def worst(self) -> list[RandomWorldRow]:
        """Return the row with the worst hand, for each law and kind."""
        groups: dict[tuple[str, str], list[int]] = {}
        for i, row in enumerate(self.rows):
            groups.setdefault((row.law, row.kind), []).append(i)
        return [self.rows[max(those, key=self._rank)] for those in groups.values()]

    def _rank(self, i: int) -> tuple[bool, float, float, float]:
        """Return the rank of the worst hand of a row."""
        row = self.rows[i]
        held, drawn = self.held_back_s[i][row.worst_hand], self.drawn_J[i][row.worst_hand]
        return HandRun(None if np.isnan(held) else float(held), float(drawn), row.faults > 0).rank

    def scenario(self, row: RandomWorldRow, hand: int | None = None) -> Scenario:
        """Return the scenario of a hand.

        Parameters
        ----------
        row : RandomWorldRow
            One of `rows`.
        hand : int, optional
            Its index, at least 0; default: the worst of the row.
        """
        require(row, RandomWorldRow, "RandomWorlds.scenario", "one of its rows")
        return random_scenario(
            row.kind,
            row.device,
            row.worst_hand if hand is None else hand,
            stiffness=row.stiffness_N_per_m,
            delay=row.delay_samples,
            moving=self.moving,
            noise=self.noise_N,
            lag=self.lag_s,
            seed=self.seed,
        )

    def trace(self, row: RandomWorldRow, hand: int | None = None) -> Trace:
        """Simulate a hand of a row again, by default its worst, with every row up to a fault."""
        require(row, RandomWorldRow, "RandomWorlds.trace", "one of its rows")
        law = self.laws[row.law]
        scenario = on_its_observer(self.scenario(row, hand), law)
        return every_row(scenario, design(law, scenario.device, scenario.known_timing))

    def __repr__(self) -> str:
        """Return the rows with their units."""
        from ebac._util.plural import plural
        from ebac._util.report import report

        shown = (
            "kind", "device", "stiffness_N_per_m", "delay_samples", "law", "held_back",
            "longest_held_back_s", "drawn_J",
        )  # fmt: skip
        bodies = "moving" if self.moving else "still"
        return report(
            f"{plural(self.rows[0].hands, 'random hand')} a row in worlds of {bodies} bodies, simulated",
            [{key: row[key] for key in shown} for row in self.table()],
        )


class HandRun(NamedTuple):
    """What came of one hand."""

    held_back_s: float | None
    drawn_J: float
    fault: bool
    touched: bool = True

    @property
    def rank(self) -> tuple[bool, float, float, float]:
        """Larger for a hand that is more worth to look at."""
        held = self.held_back_s or 0.0
        return self.fault, held if held > HELD_BACK else 0.0, self.drawn_J, held


def _together(rows: list[RandomWorldRow], worst: RandomWorldRow) -> RandomWorldRow:
    """Return the rows of a law as one, named after its worst."""
    guarded, has_reserve = worst.held_back is not None, worst.beyond_reserve is not None
    return replace(
        worst,
        hands=sum(row.hands for row in rows),
        touched=sum(row.touched for row in rows),
        held_back=sum(row.held_back or 0 for row in rows) if guarded else None,
        longest_held_back_s=max(row.longest_held_back_s or 0.0 for row in rows) if guarded else None,
        drawn_J=max(row.drawn_J for row in rows),
        beyond_reserve=sum(row.beyond_reserve or 0 for row in rows) if has_reserve else None,
        faults=sum(row.faults for row in rows),
    )  # fmt: skip
