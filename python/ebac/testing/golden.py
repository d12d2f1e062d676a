"""Golden traces: a trace and what it comes to, stored beside a test and compared in every run."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ebac._util.arguments import require, whole
from ebac._util.atomic_file import draft, write_text
from ebac._util.file_names import file_name
from ebac._util.wrong_calls import plain_function
from ebac.metrics import contact
from ebac.testing.compare import Comparison, check_columns, compare
from ebac.testing.metric import METRICS, Metrics, check_names, differences, metrics_of
from ebac.testing.times import within_run
from ebac.testing.tolerance import Tolerance
from ebac.trace import Trace
from ebac.trace.files import write_npz

if TYPE_CHECKING:
    import pytest

#: What is stored unless columns are named: the force at the handle and the command of the law.
COLUMNS = ("x", "v", "f_env", "f_cmd", "f_applied", "fault")


@dataclass(frozen=True)
class TraceRegression:
    """What the fixture `ebac_trace` gives.

    Attributes
    ----------
    folder : Path
        Where the golden traces of this test lie.
    name : str
        File name of its golden trace, without ending.
    update : bool
        Whether to write instead of comparing (`--ebac-update`).
    pictures : Path
        Where an overlay is drawn when something differs: the test's `tmp_path`.
    """

    folder: Path
    name: str
    update: bool
    pictures: Path

    @classmethod
    def of(cls, request: pytest.FixtureRequest) -> TraceRegression:
        """Make it for a test.

        Raises
        ------
        ValueError
            When the golden trace of another test has the same file.
        """
        config, node = request.config, request.node
        setting = config.getini("ebac_golden")
        folder = config.rootpath / setting if setting else request.path.with_suffix("")
        name = _name(node)
        for other in request.session.items:
            near = setting or other.path == node.path
            twin = other.nodeid != node.nodeid and _name(other) == name
            if near and twin and _takes_traces(other):
                raise ValueError(
                    f"{other.nodeid} and {node.nodeid} have the same golden trace, {folder / name}.npz: rename one"
                )
        return cls(
            folder=folder,
            name=name,
            update=bool(config.getoption("--ebac-update")),
            pictures=request.getfixturevalue("tmp_path"),
        )

    @plain_function
    def check(
        self,
        trace: Trace,
        *,
        columns: Sequence[str] | None = None,
        tolerances: Mapping[str, Tolerance] | None = None,
        metrics: bool = True,
        metric_tolerances: Mapping[str, float] | None = None,
        every: int = 1,
        until: float | None = None,
        name: str | None = None,
    ) -> Comparison:
        """Compare a trace with the golden one of this test.

        Parameters
        ----------
        trace : Trace
            What the test measured or simulated.
        columns : sequence of str, optional
            What is stored and compared; default: x, v, f_env, f_cmd, f_applied and fault, where the trace has them.
        tolerances : mapping of str to Tolerance, optional
            By column; default: by unit, see `ebac.testing.default_tolerance`.
        metrics : bool
            Whether rest, deviation, swing, settling, least energy, clamp share and others are stored and compared too.
        metric_tolerances : mapping of str to float, optional
            By metric, in the unit of its name: `{"swing_m": 1e-4}`.
        every : int
            Store and compare every n-th row only, >= 1. Metrics are those of the whole trace.
        until : float, optional
            Compare rows up to this time only [s], within the run; all are stored. A limit cycle does not repeat its
            digits elsewhere.
        name : str, optional
            Name of the golden trace; needed for a second one in the same test.

        Returns
        -------
        Comparison
            Of the channels, without a divergence.

        Raises
        ------
        AssertionError
            When something differs, or the golden trace or its metrics were missing: what was missing is then written,
            and the test fails once.
        KeyError, ValueError
            For columns, tolerances or numbers that cannot be.
        """
        __tracebackhide__ = True
        require(trace, Trace, "ebac_trace.check", "a Trace")
        if whole("every", every) < 1:
            raise ValueError(f"every = {every}: must be at least 1")
        if isinstance(columns, str):
            raise TypeError(f"columns = {columns!r}: must be a sequence, such as [{columns!r}]")
        trace.between(None, until)  # refuses what is no time
        if until is not None:
            within_run("until", until, trace["t"], "where the run ends: leave it out for all rows")
        check_names(metric_tolerances or {})
        chosen = [c for c in COLUMNS if c in trace] if columns is None else list(columns)
        check_columns(tolerances or {}, ["t", *chosen])
        found = _part(trace, chosen, every)
        came_to = metrics_of(contact(trace)) if metrics else None
        where = self.folder / (file_name(name, "trace") if name else self.name)
        golden_file = where.with_name(where.name + ".npz")
        metrics_file = where.with_name(where.name + ".json")
        missing = [f for f in (golden_file, metrics_file)[: 1 + metrics] if not f.exists()]
        golden_file.parent.mkdir(parents=True, exist_ok=True)
        if self.update or golden_file in missing:
            with draft(golden_file) as new:
                write_npz(found, new)
        if came_to is not None and (self.update or metrics_file in missing):
            write_text(metrics_file, json.dumps(came_to, indent=2, allow_nan=False) + "\n")
        if missing and not self.update:
            what = "golden trace" if golden_file in missing else "file of golden metrics"
            also = "".join(f" and {file.name}" for file in missing[1:])
            raise AssertionError(
                f"there was no {what}: written to {missing[0]}{also}; look at it, commit it, run again"
            )
        golden = Trace.from_npz(golden_file)
        known = _known(metrics_file) if metrics else {}
        return self._judge(found, golden, chosen, tolerances, until, came_to or {}, known,
                           metric_tolerances or {}, golden_file)  # fmt: skip

    def _judge(
        self, found: Trace, golden: Trace, columns: list[str], tolerances: Mapping[str, Tolerance] | None,
        until: float | None, came_to: Metrics, known: Metrics, allowed: Mapping[str, float], file: Path,
    ) -> Comparison:  # fmt: skip
        __tracebackhide__ = True
        absent = [c for c in columns if c not in golden]
        if absent:
            raise AssertionError(f"{file} has no column {', '.join(absent)}; {_remedy()}")
        try:
            result = compare(
                found[:until], golden[:until], columns=["t", *columns],
                tolerances={"t": Tolerance(absolute=1e-9), **(tolerances or {})},
            )  # fmt: skip
        except ValueError as error:
            raise AssertionError(f"{file}: {error}; {_remedy()}") from None
        moved = differences(came_to, known, allowed)
        if result.first is None and not moved:
            return replace(result, channels=result.channels[1:])
        lines = [f"{found.law or 'the run'} differs from the golden trace {file}"]
        if result.first is not None:
            n, of = len(result.divergences), len(result.channels)
            lines.append(f"first divergence: {result.first.channel} at tick {result.first.tick}, "
                         f"t = {result.first.t:.6g} s; {n} of {of} channels differ")  # fmt: skip
        lines += [f"  {d}" for d in result.divergences]
        lines += [f"  metric {line}" for line in moved]
        lines.append(f"overlay: {self._draw(found, golden, result, file.stem)}")
        raise AssertionError("\n".join([*lines, _remedy()]))

    def _draw(self, found: Trace, golden: Trace, result: Comparison, name: str) -> Path:
        from ebac.plot.overlay import plot_overlay

        path = self.pictures / f"{name}.png"
        plot_overlay(found, golden, result.divergences).savefig(path)
        return path


def _name(test: pytest.Item) -> str:
    klass = getattr(test, "cls", None)
    return file_name(f"{klass.__name__}.{test.name}" if klass else test.name, "trace")


def _takes_traces(test: pytest.Item) -> bool:
    return "ebac_trace" in getattr(test, "fixturenames", ())


def _known(file: Path) -> Metrics:
    """Return golden metrics.

    Raises
    ------
    ValueError
        When the file holds none, as one with the marks of a merge.
    """
    try:
        known: Metrics = dict(json.loads(file.read_text(encoding="utf-8")))
    except (TypeError, ValueError):
        known = {}
    if not known.keys() & METRICS.keys():
        raise ValueError(f"{file}: holds no golden metrics; {_remedy()}")
    return known


def _part(trace: Trace, columns: Sequence[str], every: int) -> Trace:
    """Return time, tick and some columns of every n-th row."""
    names = dict.fromkeys(["tick"] * ("tick" in trace) + ["t", *columns])
    return Trace(
        data={name: trace[name][::every] for name in names},
        columns={name: trace.columns[name] for name in names},
        axes=trace.axes,
        scenario=trace.scenario,
        law=trace.law,
        law_repr=trace.law_repr,
        origin=trace.origin,
        changed=trace.changed,
    )


def _remedy() -> str:
    return "if it is meant to differ: pytest --ebac-update, look at the changed files, commit them"
