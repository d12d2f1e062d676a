"""The result of a sweep: named columns, one row per run."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import named, require_path
from ebac._util.atomic_file import draft
from ebac._util.need import need
from ebac._util.plural import plural

if TYPE_CHECKING:
    import pandas as pd

    from ebac.studies.sweeps.measure import Columns

#: How the columns of swept parameters begin.
_SWEPT = ("device", "hand", "environment", "timing", "jitter", "seconds_s", "observer")
#: What a row shows of a run.
_CONTACT = ("rest_m", "ideal_m", "swing_m", "settled_s", "least_energy_J")


@dataclass(frozen=True, eq=False)
class SweepResult:
    """One row per run: all scenarios under the first law, then all under the second, and so on.

    `result["swing_m"]` is a NumPy array; NaN where a thing does not exist.

    Attributes
    ----------
    columns : dict of str to array, shape (runs,)
        `law` (its name), `scenario` (its place in what was swept), `seed`; each parameter in which the
        scenarios differ, `environment.stiffness_N_per_m` and so on; `ideal_m`, `count_m`,
        `allowed_m` and the numbers of
        `Contact`, under the same names; `still`, `force_quiet`, `quiet` (False for a run that ended
        early); `ticks` (rows simulated), `fault`, `diverged` (beyond the limits, ended
        early), `done` (False when the sweep was interrupted before).
    """

    columns: Columns

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Return a column by name."""
        return named("column", name, self.columns)

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the columns."""
        return iter(self.columns)

    def __len__(self) -> int:
        """Return the number of runs."""
        return len(self.columns["law"])

    @property
    def swept(self) -> tuple[str, ...]:
        """The columns of the parameters in which the scenarios differ."""
        return tuple(name for name in self.columns if name.startswith(_SWEPT))

    @property
    def deviation_m(self) -> NDArray[np.float64]:
        """Rest minus ideal [m]; positive is too deep."""
        return np.asarray(self["rest_m"] - self["ideal_m"])

    @property
    def exact(self) -> NDArray[np.bool_]:
        """Whether each run rests within `allowed_m` of the ideal; False, too, where there is none: `ideal_m` is NaN."""
        return np.asarray(np.abs(self.deviation_m) <= self["allowed_m"])

    @property
    def exact_and_still(self) -> NDArray[np.bool_]:
        """Whether each run is good to its end by its position alone, whatever its force does."""
        return np.asarray(self.exact & self["still"])

    @property
    def good(self) -> NDArray[np.bool_]:
        """Whether each run is exact and quiet, in position and force, to its end."""
        return np.asarray(self.exact & self["quiet"])

    def to_pandas(self) -> pd.DataFrame:
        """Return a DataFrame, one run a row."""
        need("pandas", "SweepResult.to_pandas")
        import pandas as pd

        return pd.DataFrame(self.columns)

    def to_csv(self, path: str | Path) -> None:
        """Write CSV; the unit is in each name, numbers keep every digit, NaN is an empty cell.

        Raises
        ------
        OSError
            When the file cannot be written; one of that name stays as it is.
        """
        require_path(path, "SweepResult.to_csv")
        with draft(path) as name, name.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(self.columns)
            for row in zip(*(values.tolist() for values in self.columns.values()), strict=True):
                writer.writerow("" if cell != cell else cell for cell in row)

    def to_parquet(self, path: str | Path) -> None:
        """Write Parquet, with a checksum of each page; needs `pip install 'ebac[sweep]'`.

        Raises
        ------
        ImportError
            Without pyarrow.
        OSError
            When the file cannot be written; one of that name stays as it is.
        """
        require_path(path, "SweepResult.to_parquet")
        try:
            import pyarrow
            import pyarrow.parquet
        except ImportError as error:
            raise ImportError("Parquet needs pyarrow: pip install 'ebac[sweep]'") from error
        table = pyarrow.table(dict(self.columns))
        with draft(path) as name:
            pyarrow.parquet.write_table(table, name, write_page_checksum=True)

    def rows(self) -> list[dict[str, Any]]:
        """Return one row per run: its law, scenario and swept parameters, and what its contact came to."""
        keys = ("law", "scenario", *self.swept, *_CONTACT)
        columns = [self[key].tolist() for key in keys]
        return [
            {key: None if cell != cell else cell for key, cell in zip(keys, cells, strict=True)}
            for cells in zip(*columns, strict=True)
        ]

    def _repr_html_(self) -> str:
        """Return a figure and the runs, for a notebook."""
        from ebac._util import notebook
        from ebac.plot import plot_sweep

        return notebook.result(self._title(), self.rows(), lambda: plot_sweep(self))

    def __repr__(self) -> str:
        """Return runs, laws, and the first and last rows: what was swept and what came of it."""
        from ebac._util.report import report

        return report(self._title(), self.rows(), keys=("law", "scenario"))

    def _title(self) -> str:
        laws = ", ".join(dict.fromkeys(self["law"].tolist()))
        return (
            f"SweepResult: {plural(len(self), 'run')} under {laws}, {int(self['done'].sum())} done"
        )
