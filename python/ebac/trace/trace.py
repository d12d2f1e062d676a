"""A trace: named columns with units, one row per tick, without copies."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from copy import copy
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ebac import _core
from ebac._util.arguments import require_file, require_path, unknown_name, whole
from ebac._util.atomic_file import draft
from ebac._util.need import need
from ebac._util.plural import plural
from ebac.scenario import Scenario
from ebac.trace.columns import MEANT, ColumnInfo, column_infos, row_views
from ebac.trace.time_slice import rows_between

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from ebac.explore import Exploration
    from ebac.trace.text import Text


class Trace:
    """The rows of a run: what every stage of the loop knew in every tick.

    `trace["x"]` is a NumPy view of the rows as the loop wrote them, shape (rows,) for one axis and for
    columns of the whole row, (rows, axes) otherwise. `trace[1.0:2.5]` is the part between two times [s], without a
    copy. Columns `law.*` are the law's own state, columns `true.*` what only a simulation can know. `changed`: whether
    law, world, delay or the hand's target were changed during the run; `scenario` then holds for the first rows alone.
    """

    def __init__(
        self,
        *,
        data: dict[str, NDArray[Any]],
        columns: dict[str, ColumnInfo],
        axes: int,
        scenario: Scenario | None = None,
        law: str = "",
        law_repr: str = "",
        origin: str = "",
        changed: bool = False,
    ) -> None:
        self._data = data
        self.columns = columns
        self.axes = axes
        self.scenario = scenario
        self.law = law
        self.law_repr = law_repr
        self._origin = origin
        self.changed = changed

    @classmethod
    def from_rows(
        cls,
        rows: _core.Rows,
        *,
        scenario: Scenario | None,
        law: str,
        law_repr: str,
        origin: str = "",
        changed: bool = False,
    ) -> Self:
        """Look at rows of the core.

        Parameters
        ----------
        rows : Rows
            Not copied.
        scenario : Scenario or None
            What was run.
        law, law_repr : str
            The law's name, and its text that evaluates to an equal one.
        origin : str
            What a title calls them; default: simulated or recorded, by their columns.
        changed : bool
            Whether law or world was changed while it ran.
        """
        data, columns = row_views(rows, rows.bytes()), column_infos(rows)
        return cls(
            data=data,
            columns=columns,
            axes=rows.axes,
            scenario=scenario,
            law=law,
            law_repr=law_repr,
            origin=origin,
            changed=changed,
        )

    @property
    def origin(self) -> str:
        """What a title calls the rows: "simulated", "recorded", or what their log says."""
        return self._origin or ("simulated" if "true.x" in self else "recorded")

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self._data["t"])

    def __contains__(self, name: object) -> bool:
        """Whether there is a column of that name."""
        return name in self._data

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the columns."""
        return iter(self._data)

    @overload
    def __getitem__(self, key: str) -> NDArray[Any]: ...
    @overload
    def __getitem__(self, key: slice) -> Self: ...
    def __getitem__(self, key: str | slice) -> NDArray[Any] | Self:
        """Return a column by name, or the part between two times [s]."""
        if isinstance(key, slice):
            return self.between(key.start, key.stop, key.step)
        if not isinstance(key, str):
            raise TypeError(
                f"trace[{key!r}]: must be the name of a column, or two times [s] as in trace[1.0:2.5]"
            )
        if key not in self._data:
            error = unknown_name("column", key, self._data, MEANT.get(key.lower(), ()))
            if "tick" not in self._data:  # rows of another program
                error.args = (f"{error}; ebac.identify.load reads logs of other programs",)
            raise error
        return self._data[key]

    def axis(self, name: str, axis: int = 0) -> NDArray[Any]:
        """Return one axis of a column, shape (rows,).

        Parameters
        ----------
        name : str
            Of the column.
        axis : int
            From 0 up.

        Raises
        ------
        ValueError
            When the trace has no such axis.
        """
        if not 0 <= whole("axis", axis) < self.axes:
            raise ValueError(f"axis = {axis}: must lie in [0, {self.axes - 1}]")
        values = self[name]
        return values if values.ndim == 1 else values[:, axis]

    def between(
        self, start: float | None = None, stop: float | None = None, step: object = None
    ) -> Self:
        """Return the rows with start <= t < stop [s], as views.

        Raises
        ------
        ValueError
            For a part outside the run or one that ends before it begins, for NaN, or for a step.
        TypeError
            For what is no time.
        """
        return self.rows(*rows_between(self._data["t"], start, stop, step))

    def rows(self, first: int, last: int) -> Self:
        """Return the rows first, ..., last - 1, as views; fewer where the trace ends before.

        Raises
        ------
        ValueError
            For a row below 0.
        """
        for name, row in (("first", first), ("last", last)):
            if whole(name, row) < 0:
                raise ValueError(f"{name} = {row}: must be at least 0")
        part = {name: values[first:last] for name, values in self._data.items()}
        return self._with(part)

    def with_column(self, name: str, values: ArrayLike) -> Self:
        """Return the trace with other values in a column it has.

        Parameters
        ----------
        name : str
            Of the column.
        values : array_like
            In the shape and unit of the column; copied.

        Raises
        ------
        KeyError
            When there is no such column.
        ValueError
            When the shape is another.
        TypeError
            When they are no real numbers.
        """
        column = np.array(values)
        if column.dtype.kind not in "biuf":
            raise TypeError(f"{name}: values of type {column.dtype}, must be real numbers")
        column.setflags(write=False)
        if column.shape != self[name].shape:
            raise ValueError(f"{name}: shape {column.shape}, must be {self[name].shape}")
        return self._with({**self._data, name: column})

    def _with(self, data: dict[str, NDArray[Any]]) -> Self:
        other = copy(self)
        other._data = data
        return other

    def head(self, rows: int = 5, *columns: str) -> Text:
        """Return the first rows as text, units in the headings.

        Parameters
        ----------
        rows : int
            How many.
        *columns : str
            Which columns; default: time, position, velocity, forces, beta and energy.
        """
        from ebac.trace.text import head

        return head(self, rows, columns)

    def summary(self) -> Text:
        """Return as text the scenario, the verdict on the contact, and the range of the main columns."""
        from ebac.trace.text import summary

        return summary(self)

    def doubts(self) -> tuple[str, ...]:
        """Return what was likely not meant of a simulated run, as texts with the remedy.

        They are a handle that leaves the workspace of its device, and a wall that is not met because the target of the
        hand lies before it. `simulate` warns of these; `Scenario.doubts` lists what is doubtful before a run.
        """
        from ebac._util.doubts.run import doubts

        return doubts(self)

    def flat(self) -> Iterator[tuple[str, ColumnInfo, NDArray[Any]]]:
        """Yield every column as one-dimensional: `x`, or `x_0`, `x_1` with several axes."""
        for name, values in self._data.items():
            info = self.columns[name]
            if values.ndim == 1:
                yield name, info, values
            else:
                for axis in range(self.axes):
                    yield f"{name}_{axis}", info, values[:, axis]

    def to_pandas(self) -> pd.DataFrame:
        """Return a DataFrame indexed by time [s]; units under `attrs["units"]`."""
        need("pandas", "trace.to_pandas")
        import pandas as pd

        columns = list(self.flat())
        frame = pd.DataFrame({name: values for name, _, values in columns}).set_index("t")
        frame.attrs["units"] = {name: info.unit for name, info, _ in columns}
        return frame

    def save(
        self,
        path: str | Path,
        *,
        profile: str = "ebac",
        progress: Callable[[int, int], None] | None = None,
    ) -> None:
        """Write a file, the format by its extension: .mcap, .npz, .csv, .parquet, .mat or .h5.

        A log, .mcap, opens in PlotJuggler and Foxglove and holds all a trace has. The file appears when it is whole,
        and replaces one of that name. A scenario with a hand or world of one's own is left out, with a warning.

        Parameters
        ----------
        path : str or Path
            Name of the file.
        profile : str
            Of .mcap: `ebac` for a log, or `ros2` for a bag of ROS 2, which rosbags and mcap-ros2-support read and
            ebac does not.
        progress : callable, optional
            Called with rows written and rows in all.

        Raises
        ------
        ValueError
            For another extension or profile.
        ModuleNotFoundError
            When the library a format needs is not installed; the message names what to install.
        """
        from ebac.logs.files import save

        save(self, path, profile=profile, progress=progress)

    @classmethod
    def load(cls, path: str | Path) -> Trace:
        """Read a file, the format by its extension: .mcap (also cut short), .npz, .csv, .parquet, .mat or .h5.

        Raises
        ------
        FileNotFoundError
            When there is no such file.
        ValueError
            For another extension, or a file that is not in the format of its extension.
        """
        from ebac.logs.files import load

        return load(path)

    def to_csv(
        self, path: str | Path, *, progress: Callable[[int, int], None] | None = None
    ) -> None:
        """Write CSV with the unit in each heading, `x [m]`; numbers keep every digit.

        The file appears when it is whole, and replaces one of that name.

        Raises
        ------
        OSError
            When the file cannot be written; one of that name stays as it is.
        """
        from ebac.trace.files import write_csv

        require_path(path, "Trace.to_csv")
        with draft(path) as name:
            write_csv(self, name, progress)

    def to_npz(self, path: str | Path) -> None:
        """Write a compressed NumPy archive: the columns, and units, scenario and law under `about`.

        The file appears when it is whole, and replaces one of that name. A scenario with a hand or world of one's own
        is left out, with a warning.

        Raises
        ------
        OSError
            When the file cannot be written; one of that name stays as it is.
        """
        from ebac.scenario_text import warn_without_text
        from ebac.trace.files import write_npz

        require_path(path, "Trace.to_npz")
        with draft(path) as name:
            write_npz(self, name)
        warn_without_text(self.scenario, path, stacklevel=2)

    @classmethod
    def from_npz(cls, path: str | Path) -> Self:
        """Read what `to_npz` wrote.

        Raises
        ------
        FileNotFoundError
            When there is no such file.
        ValueError
            When it is not such an archive.
        """
        from ebac.trace.files import npz_parts

        require_file(path, "Trace.from_npz")
        return cls(**npz_parts(path))

    def plot(self, *columns: str | Sequence[str], scale: str | None = None) -> Figure:
        """Draw position, force, energy and, of a law that limits it, beta over time; or columns by name.

        `trace.plot("law.energy", "f_cmd")` draws a panel for each unit; `scale`, "linear" or "log", is that of columns
        in N/m, such as `law.beta`. See `ebac.plot.plot_trace` and `plot_columns`.
        """
        from ebac.plot import plot_columns, plot_trace

        names = [n for one in columns for n in ([one] if isinstance(one, str) else one)]
        return plot_columns(self, names, scale=scale) if columns else plot_trace(self, scale=scale)

    def explore(self, *columns: str | Sequence[str], axis: int = 0) -> Exploration:
        """Look at the rows in a notebook, however many: linked panels to zoom and move in, no peak lost.

        `trace.explore()` shows position, force, beta and energy; `trace.explore("x", ["f_cmd", "f_meas"])` a panel
        for each group of columns. Needs `pip install 'ebac[notebook]'`. See `ebac.explore.explore`.
        """
        from ebac.explore import explore

        return explore(self, *columns, axis=axis)

    def __repr__(self) -> str:
        """Return one line: law, rows, time, axes."""
        t = self._data["t"]
        span = f"{t[0]:.6g} to {t[-1]:.6g} s" if len(t) else "empty"
        axes = plural(self.axes, "axis", "axes")
        return f"<Trace of {self.law or 'a run'}: {len(self)} rows, {span}, {axes}>"

    def _repr_html_(self) -> str:
        """Return a small picture and a table of the columns for a notebook."""
        from ebac._util.notebook import picture, table_of_columns

        shown = picture(self.plot) if len(self) > 1 else ""
        return f"<p>{escape(repr(self))}</p>{shown}{table_of_columns(self.flat())}"
