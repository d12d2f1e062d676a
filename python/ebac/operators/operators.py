"""Populations of operators: hands of eq. (4), each with the depth it wants to reach."""

from __future__ import annotations

import csv
import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ebac._core import Hand, Step, Wall
from ebac._util.arguments import (
    require,
    require_file,
    require_path,
    unknown,
)
from ebac._util.atomic_file import draft
from ebac._util.need import need
from ebac._util.wrong_calls import plain_constructor
from ebac.operators.columns import (
    APPROACH,
    OPERATOR_COLUMNS,
    check,
    in_si,
    meant,
    numbers,
    read_csv,
)
from ebac.operators.draws import combinations, random_rows

if TYPE_CHECKING:
    import pandas as pd

    from ebac.scenario import Scenario

#: Largest steady pull of a hand K0 X0 in the populations of this package [N], below what a motor gives.
MOST_PULL = 35.0


@plain_constructor
@dataclass(frozen=True, eq=False, init=False)
class Operators:
    """A population of hands, one row each; read-only columns of one length, SI units in the names.

    Parameters
    ----------
    m_kg, b_Ns_per_m, k_N_per_m : array-like, shape (n,)
        Mass [0, 10] kg, damping [0, 1000] N s/m and stiffness [0, 1e5] N/m of eq. (4).
    target_m : array-like, shape (n,)
        Where the hand wants to be [-1, 1] m, from the wall's surface.
    approach_m : array-like, shape (n,) or number
        Length of its free motion before contact with the wall, [0, 1] m; default: 10 mm. A hand that starts on the
        surface (0) brings hardly any energy into the contact, see the condition `surface`.
    tremor_m, tremor_Hz : array-like, shape (n,) or number
        Amplitude [0, 0.1] m and frequency [0, 500] Hz of its tremor.

    Raises
    ------
    ValueError
        For a number out of range, or columns of several lengths; names column, row, value, unit and range.
    """

    m_kg: NDArray[np.float64]
    b_Ns_per_m: NDArray[np.float64]
    k_N_per_m: NDArray[np.float64]
    target_m: NDArray[np.float64]
    approach_m: NDArray[np.float64]
    tremor_m: NDArray[np.float64]
    tremor_Hz: NDArray[np.float64]

    def __init__(
        self,
        *,
        m_kg: ArrayLike,
        b_Ns_per_m: ArrayLike,
        k_N_per_m: ArrayLike,
        target_m: ArrayLike,
        approach_m: ArrayLike = APPROACH,
        tremor_m: ArrayLike = 0.0,
        tremor_Hz: ArrayLike = 9.0,
    ) -> None:
        every = (m_kg, b_Ns_per_m, k_N_per_m, target_m, approach_m, tremor_m, tremor_Hz)
        columns = dict(zip(OPERATOR_COLUMNS, every, strict=True))
        given = {name: numbers(name, values) for name, values in columns.items()}
        n = next((values.size for values in given.values() if values.ndim > 0), 1)
        if n == 0:
            raise ValueError("the population is empty: give at least one operator")
        for name, values in given.items():
            if values.shape not in ((), (n,)):
                raise ValueError(
                    f"{name} has the shape {values.shape}: all columns have the shape ({n},), "
                    "or are one number"
                )
            column = np.array(np.broadcast_to(values, n))
            check(OPERATOR_COLUMNS[name], column)
            column.setflags(write=False)
            object.__setattr__(self, name, column)

    @classmethod
    def grid(
        cls,
        *,
        mass: Sequence[float] = (0.05, 0.15, 0.5, 1.0),
        damping: Sequence[float] = (2.0, 6.0, 20.0),
        stiffness: Sequence[float] = (100.0, 300.0, 1000.0),
        target: Sequence[float] = (0.02, 0.04),
        most_pull: float = MOST_PULL,
        **columns: float,
    ) -> Self:
        """Return every combination whose steady pull K0 X0 is at most `most_pull`; by default 60 hands.

        Parameters
        ----------
        mass, damping, stiffness, target : sequence of float
            M0 [kg], B0 [N s/m], K0 [N/m], X0 [m].
        most_pull : float
            Largest K0 X0 [N].
        **columns
            The same for all: `approach_m`, `tremor_m`, `tremor_Hz`.

        Raises
        ------
        ValueError
            For a number out of range, or when no combination is left.
        TypeError
            For what is no sequence of numbers.
        """
        rows = combinations(mass, damping, stiffness, target, most_pull)
        return cls._from_rows(rows, columns)

    @classmethod
    def sample(
        cls, n: int, seed: int = 1, *, most_pull: float = MOST_PULL, **columns: float
    ) -> Self:
        """Return `n` random operators; the first ones of a larger population of the same seed are the same.

        Mass 0.03 to 1.5 kg, damping 1 to 25 N s/m and stiffness 50 to 1200 N/m are log-uniform, the target of 10 to
        60 mm is uniform; what pulls with more than `most_pull` [N] is drawn again.

        Parameters
        ----------
        n : int
            How many, at least 1.
        seed : int
            Of NumPy's PCG64, at least 0.
        most_pull : float
            Largest K0 X0 [N], at least 0.5 N, the least that can be drawn.
        **columns
            The same for all: `approach_m`, `tremor_m`, `tremor_Hz`.

        Raises
        ------
        ValueError
            For a number out of range.
        TypeError
            For what is no number, or no whole one.
        """
        return cls._from_rows(random_rows(n, seed, most_pull), columns)

    @classmethod
    def _from_rows(cls, rows: NDArray[np.float64], columns: Mapping[str, Any]) -> Self:
        names = ("m_kg", "b_Ns_per_m", "k_N_per_m", "target_m")
        return cls(**dict(zip(names, rows.T, strict=True)), **columns)

    @classmethod
    def from_columns(cls, table: Mapping[str, ArrayLike]) -> Self:
        """Make a population from named columns; see the class for their names; `k [N/mm]` is understood too.

        Raises
        ------
        ValueError
            For a column that is missing or unknown, or a value that is no number or out of its range.
        """
        require(table, Mapping, "Operators.from_columns", "columns by name")
        known, table = list(OPERATOR_COLUMNS), in_si(table)
        for name in table:
            if name not in OPERATOR_COLUMNS:
                raise ValueError(
                    unknown(f"column {name}", str(name), known, meant=meant(str(name)))
                )
        missing = [c.name for c in OPERATOR_COLUMNS.values() if c.required and c.name not in table]
        if missing:
            raise ValueError(
                f"column {missing[0]} is missing; needed are m_kg, b_Ns_per_m, k_N_per_m, target_m"
            )
        return cls(**table)

    @classmethod
    def from_dataframe(cls, frame: pd.DataFrame) -> Self:
        """Make a population from a DataFrame with the columns of the class; errors as `from_columns`."""
        return cls.from_columns({str(name): frame[name].tolist() for name in frame.columns})

    @classmethod
    def from_csv(cls, path: str | Path) -> Self:
        """Read a population from CSV: a heading with the names of the columns, then one operator a line.

        Raises
        ------
        FileNotFoundError
            When there is no such file.
        ValueError
            As `from_columns`, with the file's name; rows are counted from 1 below the heading.

        Warns
        -----
        UserWarning
            When the last line has no end, and so its last number may be cut.
        """
        require_file(path, "Operators.from_csv")
        try:
            return cls.from_columns(read_csv(path))
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from None

    def to_csv(self, path: str | Path) -> None:
        """Write CSV that `from_csv` reads; numbers keep every digit.

        Raises
        ------
        OSError
            When the file cannot be written; one of that name stays as it is.
        """
        require_path(path, "Operators.to_csv")
        columns = self.columns()
        with draft(path) as name, name.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(columns)
            writer.writerows(zip(*(values.tolist() for values in columns.values()), strict=True))

    def columns(self) -> dict[str, NDArray[np.float64]]:
        """Return every column by its name."""
        return {name: getattr(self, name) for name in OPERATOR_COLUMNS}

    def to_pandas(self) -> pd.DataFrame:
        """Return a DataFrame, one operator a row."""
        need("pandas", "Operators.to_pandas")
        import pandas as pd

        return pd.DataFrame(self.columns())

    def replace(self, **columns: ArrayLike) -> Self:
        """Return a copy with some columns changed; one number stands for all operators."""
        return type(self).from_columns({**self.columns(), **columns})

    def hands(self) -> list[Hand]:
        """Return the hands; each one's target lies `approach_m + target_m` from where it starts."""
        return [
            Hand(
                mass=m, damping=b, stiffness=k, tremor_amplitude=a, tremor_frequency=f,
                path=Step(target=approach + target),
            )
            for m, b, k, target, approach, a, f in self._rows()
        ]  # fmt: skip

    def scenarios(self, base: Scenario) -> list[Scenario]:
        """Return `base` with each hand on it, and its wall `approach_m` farther away.

        Raises
        ------
        ValueError
            When an operator approaches but `base` has no wall.
        """
        from ebac.scenario import Scenario

        require(base, Scenario, "Operators.scenarios", "a Scenario")
        wall = base.environment
        scenarios = []
        for hand, approach in zip(self.hands(), self.approach_m.tolist(), strict=True):
            changes: dict[str, Any] = {"hand": hand}
            if approach > 0:
                if not isinstance(wall, Wall):
                    kind = type(wall).__name__
                    raise ValueError(
                        f"approach_m = {approach:g} m: needs a Wall, the scenario has a {kind}; "
                        "start on the surface, as with Operators.grid(approach_m=0) or "
                        "Operators.sample(n, seed, approach_m=0)"
                    )
                changes["environment"] = wall.replace(position=wall.position + approach)
            scenarios.append(base.replace(**changes))
        return scenarios

    def name(self, i: int) -> str:
        """Return operator `i` in words: "0.05 kg, 2 N s/m, 100 N/m, 40 mm"."""
        m, b, k, x = (
            float(c[i]) for c in (self.m_kg, self.b_Ns_per_m, self.k_N_per_m, self.target_m)
        )
        return f"{m:.3g} kg, {b:.3g} N s/m, {k:.4g} N/m, {1e3 * x:.3g} mm"

    def _rows(self) -> Iterable[tuple[float, ...]]:
        return zip(*(values.tolist() for values in self.columns().values()), strict=True)

    def __len__(self) -> int:
        """Return how many operators there are."""
        return len(self.m_kg)

    def __getitem__(self, part: int | slice | Sequence[int]) -> Self:
        """Return some of the operators; of one number, that one alone."""
        chosen = part if isinstance(part, slice) else np.atleast_1d(part)
        return type(self)(**{name: values[chosen] for name, values in self.columns().items()})

    def __eq__(self, other: object) -> bool:
        """Whether every number is the same."""
        if not isinstance(other, Operators):
            return NotImplemented
        mine, theirs = self.columns(), other.columns()
        return all(np.array_equal(mine[name], theirs[name]) for name in mine)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Return how many, and the range of each of the four numbers."""
        spans = (
            f"{name} {values.min():.4g} to {values.max():.4g}"
            for name, values in itertools.islice(self.columns().items(), 4)
        )
        return f"<{len(self)} Operators: {', '.join(spans)}>"
