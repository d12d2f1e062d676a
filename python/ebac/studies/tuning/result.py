"""What a search found: the parameters, and how the law does on the test hands."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ebac._util.formatting import quantity
from ebac.laws import AnyLaw
from ebac.laws.variant import shown_value
from ebac.studies.result import Study

#: What is much more energy drawn than by the design: this many times as much, and at least this much more [J].
MUCH_MORE, AT_LEAST = 10, 1e-3


@dataclass(frozen=True, kw_only=True)
class TunedRow:
    """A law under one condition, over the test hands; None where there is none.

    Attributes
    ----------
    condition : str
        Its name.
    hands, good : int
        Hands, and the good ones: exact, and quiet in position and force.
    exact_and_still : int
        Hands that are exact and still, whatever their force does.
    settled_in_time : int or None
        Of these, hands that settle within 1.5 times what they need at an ideal wall, plus 0.2 s; None where that is
        not known.
    median_impact_share : float or None
        Median share of the wall's stiffness on impact.
    median_settled_s : float or None
        Median over the good hands of the time from which on position and force have settled [s].
    least_energy_J, most_drawn_J : float or None
        Least energy of the port, and energy drawn in any window of any run [J].
    force_swing_N : float or None
        Largest force swing at rest of a hand that is exact and still [N].
    """

    condition: str
    hands: int
    good: int
    exact_and_still: int
    settled_in_time: int | None
    median_impact_share: float | None
    median_settled_s: float | None
    least_energy_J: float | None
    most_drawn_J: float | None
    force_swing_N: float | None


@dataclass(frozen=True, kw_only=True)
class Tuned:
    """A law tuned for one delay.

    Attributes
    ----------
    law : str
        Its name.
    variant : law
        The law with the parameters found, to be used wherever a law can be.
    delay : int
        Transport delay [samples] of the conditions.
    observer : bool
        Whether the law acted on the estimate of an observer, which `base` gives with "every-law".
    changes : dict
        The parameters found, in SI units; none where the design is best.
    tried : int
        Points that were tried, the default among them.
    cost, default_cost : float
        Of the training hands, see `cost_of`.
    test, default : tuple of TunedRow
        One per condition, of the test hands: with these parameters, and with those of the design.
    parameters : tuple of dict
        What was searched, in SI units: `name`, `value` (None where the design is best), `unit`, and `low` and `high` of
        the range; 0 and 1 for a switch.
    at_bounds : tuple of str
        Which parameters found stand at a bound of their range, in words, and what to do.
    """

    law: str
    variant: AnyLaw
    delay: int
    observer: bool
    changes: dict[str, float | bool]
    tried: int
    cost: float
    default_cost: float
    test: tuple[TunedRow, ...]
    default: tuple[TunedRow, ...]
    parameters: tuple[dict[str, Any], ...] = ()
    at_bounds: tuple[str, ...] = ()

    @property
    def worse(self) -> tuple[str, ...]:
        """Where the design does better on the test hands, in words, one per condition.

        Fewer hands are good, or more than ten times the energy is drawn, and at least 1 mJ more.
        """
        found = []
        for design, tuned in zip(self.default, self.test, strict=True):
            before, now = design.most_drawn_J or 0.0, tuned.most_drawn_J or 0.0
            drawn = now > MUCH_MORE * before and now - before > AT_LEAST
            if drawn or tuned.good < design.good:
                found.append(
                    f"{self.law}, {tuned.condition}: worse than the design on the test hands: good {design.good} -> "
                    f"{tuned.good} of {tuned.hands}, drawn {quantity(before, 'J')} -> {quantity(now, 'J')}"
                )
        return tuple(found)

    def row(self) -> dict[str, Any]:
        """Return the documented row of `ebac tune --json`."""
        return {
            name: value
            for name, value in asdict(self).items()
            if name not in ("variant", "at_bounds")
        }

    def __repr__(self) -> str:
        """Return the parameters and how many test hands are good."""
        found = ", ".join(f"{n} = {shown_value(v)}" for n, v in self.changes.items())
        good = ", ".join(
            f"{t.condition} {t.good} of {t.hands} (before: {d.good})"
            for t, d in zip(self.test, self.default, strict=True)
        )
        return f"<{self.law}, delay {self.delay}: {found or 'nothing better'}; good, simulated: {good}>"


class TuningInterrupted(KeyboardInterrupt):
    """A search was interrupted from the keyboard; `result` holds the best so far."""

    def __init__(self, result: list[Tuned]) -> None:
        self.result = result
        super().__init__("the best so far is kept" if result else "nothing was tried yet")


def rows_of(found: Study, law: str) -> tuple[TunedRow, ...]:
    """Return how a law does under each condition of a study."""
    rows = []
    for row in (row for row in found.rows if row.law == law):
        runs = {name: of[found.runs(law, row.condition)] for name, of in found.columns.items()}
        good, resting = runs["good"], runs["exact_and_still"]
        settled = np.maximum(runs["settled_s"], runs["force_settled_s"])[good]
        rows.append(
            TunedRow(
                condition=row.condition,
                hands=row.hands,
                good=int(good.sum()),
                exact_and_still=int(resting.sum()),
                settled_in_time=row.settled_in_time,
                median_impact_share=row.median_impact_share,
                median_settled_s=float(np.median(settled)) if len(settled) else None,
                least_energy_J=row.least_energy_J,
                most_drawn_J=row.most_drawn_J,
                force_swing_N=float(runs["force_swing_N"][resting].max())
                if resting.any()
                else None,
            )
        )
    return tuple(rows)
