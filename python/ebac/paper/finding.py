"""The result of checking one item of the paper."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Verdict: TypeAlias = Literal[
    "reproduced", "reproduced in part", "not reproduced", "nothing to compute"
]
Row: TypeAlias = dict[str, str | float | None]


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One claim of an item, and whether it holds.

    Attributes
    ----------
    text : str
        The claim, quoted or in our words.
    holds : bool
        Whether the computation confirms it.
    evidence : str
        The number that decides, with its unit.
    """

    text: str
    holds: bool
    evidence: str

    def row(self) -> dict[str, Any]:
        """Return the claim as plain values."""
        verdict = "reproduced" if self.holds else "not reproduced"
        return {"claim": self.text, "verdict": verdict, "evidence": self.evidence}


@dataclass(frozen=True, kw_only=True, repr=False)
class Finding:
    """One item of the paper, checked.

    Attributes
    ----------
    name, title : str
        Short name, "fig5", and what it shows.
    claim : str
        The paper's claim.
    rows : list of dict
        `quantity`, `value`, `unit` (SI), `paper` and `difference` (value - paper); the last two are
        None where the paper gives no number.
    verdict : str
        "reproduced", "reproduced in part", "not reproduced", or "nothing to compute" for a photograph or a diagram.
    why : str
        The reason for the verdict.
    claims : tuple of Claim
        Each claim of the item by itself; the verdict follows from them where there are any.
    figure : Figure or None
        The figure, redrawn.
    """

    name: str
    title: str
    claim: str
    rows: list[Row]
    verdict: Verdict
    why: str
    claims: tuple[Claim, ...] = ()
    figure: Figure | None = field(default=None, compare=False, repr=False)

    def __repr__(self) -> str:
        """Return title, verdict and claims."""
        lines = [f"{self.title}: {self.verdict}"]
        for claim in self.claims:
            word = "reproduced" if claim.holds else "not reproduced"
            lines.append(f"  {word}: {claim.text} ({claim.evidence})")
        return "\n".join(lines)

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
            "claims": [claim.row() for claim in self.claims],
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


def judge(*claims: bool | Claim) -> Verdict:
    """Return the verdict on the claims of an item: all, some or none of them hold."""
    holds = [claim.holds if isinstance(claim, Claim) else claim for claim in claims]
    if all(holds):
        return "reproduced"
    return "reproduced in part" if any(holds) else "not reproduced"
