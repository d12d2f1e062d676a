"""`ablation`: each piece of a law off, one at a time, over a population."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from textwrap import shorten
from typing import Any

from ebac._core import Device, Timing
from ebac._util.arguments import refuse_unknown
from ebac._util.plural import plural
from ebac._util.sequences import require_each, several
from ebac._util.wrong_calls import plain_function
from ebac.laws import AnyLaw, changed, design, law_name
from ebac.laws.protocols import is_core_law
from ebac.laws.variant import shown_value
from ebac.operators import Operators
from ebac.studies.measures import MEASURES, Measure, conditions_of
from ebac.studies.result import Study
from ebac.studies.study import study

#: Numbers that are pieces too: zero switches them off.
GAINS = ("kp", "fast_stiffness")


@dataclass(frozen=True, kw_only=True)
class Piece:
    """A piece of a law and the change that takes it away, or brings one in that is off by default.

    Attributes
    ----------
    name, meaning : str
        Of the parameter; of several, joined.
    changes : dict
        What is set on top of the design.
    """

    name: str
    meaning: str
    changes: dict[str, Any]

    @property
    def label(self) -> str:
        """Return the change in words: "guard off", "kp = 0"."""
        words = (
            f"{name} {shown_value(value)}"
            if isinstance(value, bool)
            else f"{name} = {shown_value(value)}"
            for name, value in self.changes.items()
        )
        return ", ".join(words)


@dataclass(frozen=True, kw_only=True)
class AblationRow:
    """One law of an ablation.

    Attributes
    ----------
    law : str
        Name of the law; of the piece's row, of the law it was taken from.
    piece : str or None
        Which piece was changed; None for the law as it is, and for the laws beside it.
    changes : dict
        Parameters that were set.
    hands : int
        Size of the population.
    values : dict of str to float or None
        The measures by their keys, see `MEASURES`.
    worse, better : tuple of str
        Keys of the measures that are worse, or better, than those of the law as it is.
    """

    law: str
    piece: str | None
    changes: dict[str, Any]
    label: str
    hands: int
    values: dict[str, float | None]
    worse: tuple[str, ...]
    better: tuple[str, ...]

    @property
    def earns(self) -> bool | None:
        """Whether a piece earns its place: something gets worse without it. None where no piece was changed."""
        return None if self.piece is None else bool(self.worse)

    def row(self) -> dict[str, Any]:
        """Return the documented row of `ebac ablation --json`."""
        return {
            "law": self.law,
            "piece": self.piece,
            "changes": self.changes,
            "hands": self.hands,
            **self.values,
            "worse": list(self.worse),
            "better": list(self.better),
        }


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Ablation:
    """A law, the same law without each of its pieces, and other laws beside it.

    Attributes
    ----------
    law : str
        Its name.
    pieces : tuple of Piece
        What was changed, in the order of the rows.
    beside : tuple of str
        Other laws, for the reader.
    measures : tuple of Measure
        What was looked at.
    study : Study
        Every run.
    """

    law: str
    pieces: tuple[Piece, ...]
    beside: tuple[str, ...]
    measures: tuple[Measure, ...]
    study: Study

    @cached_property
    def rows(self) -> list[AblationRow]:
        """The law as it is, then each change, then the other laws."""
        first = self._row(self.law, None, {})
        return [
            first,
            *(self._row(_row_name(self.law, p), p, first.values) for p in self.pieces),
            *(self._row(name, None, first.values) for name in self.beside),
        ]

    def __repr__(self) -> str:
        """Return what gets worse and better with each change."""
        from ebac._util.report import report

        named = {measure.key: measure.heading for measure in self.measures}
        rows = [
            {
                "change": row.label,
                "worse": _listed(named[key] for key in row.worse),
                "better": _listed(named[key] for key in row.better),
            }
            for row in self.rows
        ]
        hands = plural(len(self.study.operators), "hand")
        title = f"Ablation of {self.law}, simulated: {hands}; beside the law as it is"
        return report(title, rows)

    def _repr_html_(self) -> str:
        """Return the figure and the rows, for a notebook."""
        from ebac._util import notebook
        from ebac.plot import plot_ablation

        rows = [{"change": row.label, **row.row()} for row in self.rows]
        return notebook.result("Ablation, simulated", rows, lambda: plot_ablation(self))

    def _row(
        self, name: str, piece: Piece | None, default: Mapping[str, float | None]
    ) -> AblationRow:
        hands = len(self.study.operators)
        values = {measure.key: measure.value(self.study, name) for measure in self.measures}
        gains = {m.key: m.gain(values[m.key], default.get(m.key), hands) for m in self.measures}
        return AblationRow(
            law=name if piece is None else self.law,
            piece=None if piece is None else piece.name,
            changes={} if piece is None else dict(piece.changes),
            label=name if piece is None else piece.label,
            hands=hands,
            values=values,
            worse=tuple(key for key, gain in gains.items() if default and gain < 0),
            better=tuple(key for key, gain in gains.items() if default and gain > 0),
        )


def _listed(names: Iterable[str]) -> str:
    found = list(names)
    return shorten(f"{len(found)}: {', '.join(found)}", 42, placeholder=" ...") if found else "-"


def pieces(law: AnyLaw, changes: Sequence[Mapping[str, Any]] = ()) -> list[Piece]:
    """Return the pieces of a law: every boolean parameter turned over, every gain of `GAINS` zero, changes of yours.

    A law of the core lists its parameters; of a law in Python the boolean fields of its dataclass count.

    Parameters
    ----------
    law : str, law class, Variant, law or PythonLaw
        Whose pieces.
    changes : sequence of mapping
        More changes, each in a separate row: parameters and their values.

    Raises
    ------
    ValueError
        When there is nothing to change.
    """
    made = design(law, Device(), Timing())
    parameters = _parameters(made)
    found: list[dict[str, Any]] = [
        {name: not value} for name, value in parameters.items() if isinstance(value, bool)
    ]
    found += [{name: 0.0} for name in GAINS if parameters.get(name, 0) != 0]
    wanted = "changes that are mappings, as [{'guard': False}]"
    require_each(changes, Mapping, "ebac.ablation", wanted)
    every = [*found, *(dict(one) for one in changes if dict(one) not in found)]
    if not every:
        raise ValueError(
            f"{law_name(made)} has no boolean parameter and none of {', '.join(GAINS)}: "
            "nothing can be taken away; name a change"
        )
    known = {f.name: f.meaning for f in made.fields()} if is_core_law(made) else {}
    return [
        Piece(name=", ".join(one), meaning="; ".join(known.get(n, n) for n in one), changes=one)
        for one in every
    ]


@plain_function
def ablation(
    population: Operators | None = None,
    law: AnyLaw = "ebac",
    *,
    changes: Sequence[Mapping[str, Any]] = (),
    beside: Sequence[str] = ("tca", "eba"),
    measures: Sequence[Measure] = MEASURES,
    **run: Any,
) -> Ablation:
    """Take each piece of a law away, one at a time, and measure what gets worse.

    Parameters
    ----------
    population : Operators, optional
        The hands; default: the grid of 60.
    law : str, law class, Variant, law or PythonLaw
        Its pieces are discovered, see `pieces`. A finished law is not designed again for a condition.
    changes : sequence of mapping
        More changes, each in a separate row: `[{"pull": 40.0}]`.
    beside : sequence of str
        Other laws, for the reader.
    measures : sequence of Measure
        What to look at; decides which conditions are run.
    **run
        `base`, `seed`, `threads`, `executor`, `out`, `resume`, `progress` as in `study`.

    Returns
    -------
    Ablation

    Raises
    ------
    ValueError
        When the law has no pieces or a change is out of its range.
    TypeError
        For a law in Python that cannot be changed.
    """
    taken = inspect.signature(study).parameters.values()
    own = inspect.signature(ablation).parameters.values()
    names = [p.name for p in (*own, *taken) if p.kind is p.KEYWORD_ONLY]
    refuse_unknown("ebac.ablation", run, ["population", "law", *names])
    require_each(measures, Measure, "ebac.ablation", "measures, of ebac.studies.MEASURES")
    found = tuple(pieces(law, changes))
    name = law_name(law)
    laws: dict[str, AnyLaw] = {name: law}
    for piece in found:
        variant = changed(law, **piece.changes)
        design(variant, Device(), Timing())  # a change out of range is refused before all work
        laws[_row_name(name, piece)] = variant
    others = tuple(o for o in several("ablation: beside", beside, least=0) if o != name)
    laws |= {other: other for other in others}
    hands = Operators.grid() if population is None else population
    done = study(hands, laws, conditions_of(measures), **run)
    return Ablation(law=name, pieces=found, beside=others, measures=tuple(measures), study=done)


def _row_name(law: str, piece: Piece) -> str:
    return f"{law}, {piece.label}"


def _parameters(law: Any) -> dict[str, Any]:
    if is_core_law(law):
        return {field.name: getattr(law, field.name) for field in law.fields()}
    if dataclasses.is_dataclass(law):
        return {field.name: getattr(law, field.name) for field in dataclasses.fields(law)}
    return {}
