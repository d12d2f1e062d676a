"""What came of checking one item of the paper."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Verdict: TypeAlias = Literal["reproduced", "reproduced in part", "not reproduced"]
Row: TypeAlias = dict[str, str | float | None]


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One item of the paper, checked.

    Attributes
    ----------
    name, title : str
        Short name, "fig5", and what it shows.
    claim : str
        What the paper says.
    rows : list of dict
        `quantity`, `value`, `unit` (SI), `paper` and `difference` (value - paper); the last two are
        None where the paper gives no number.
    verdict : str
        "reproduced", "reproduced in part" or "not reproduced".
    why : str
        The reason for the verdict.
    figure : Figure or None
        The figure drawn again.
    """

    name: str
    title: str
    claim: str
    rows: list[Row]
    verdict: Verdict
    why: str
    figure: Figure | None = field(default=None, compare=False, repr=False)

    @property
    def picture(self) -> str | None:
        """Name of the figure's file."""
        return f"{self.name}.png" if self.figure is not None else None

    def document(self) -> dict[str, Any]:
        """Return the finding as plain values; the figure by the name of its file."""
        return {
            "name": self.name,
            "title": self.title,
            "claim": self.claim,
            "rows": self.rows,
            "verdict": self.verdict,
            "why": self.why,
            "figure": self.picture,
        }


def row(quantity: str, value: float | None, unit: str, paper: float | None = None) -> Row:
    """Return one number beside the paper's, SI units."""
    difference = None if value is None or paper is None else value - paper
    return {
        "quantity": quantity,
        "value": value,
        "unit": unit,
        "paper": paper,
        "difference": difference,
    }


def judge(*claims: bool) -> Verdict:
    """Return the verdict on the claims of an item: which of them hold."""
    if all(claims):
        return "reproduced"
    return "reproduced in part" if any(claims) else "not reproduced"
