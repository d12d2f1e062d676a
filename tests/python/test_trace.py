"""A trace: views without copies, slices, exports."""

import csv
import gc
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ebac

#: What a repr is made of.
PUBLIC = {name: getattr(ebac, name) for name in ebac.__all__}

TWO = ebac.Device(kinematics=ebac.Linear(axes=2))


@pytest.fixture(params=[1, 2], ids=["one axis", "two axes"])
def trace(request: pytest.FixtureRequest, run: Any) -> ebac.Trace:
    """A noisy, jittered run under the law with the most columns."""
    device = ebac.Device(
        kinematics=ebac.Linear(axes=request.param), sensor=ebac.ForceSensor(noise=0.1)
    )
    world = ebac.Corner() if request.param > 1 else ebac.Wall()
    traced = run("ebac", device=device, environment=world, seconds=0.3, jitter=0.3)
    assert isinstance(traced, ebac.Trace)
    return traced


def assert_same(one: ebac.Trace, other: ebac.Trace) -> None:
    assert list(one) == list(other)
    for name in one:
        assert one[name].dtype == other[name].dtype, name
        assert one[name].shape == other[name].shape, name
        assert one[name].tobytes() == other[name].tobytes(), name
    assert one.columns == other.columns
    assert (one.axes, one.law, one.law_repr, one.scenario) == (
        other.axes, other.law, other.law_repr, other.scenario,
    )  # fmt: skip


# --- views ---


def test_every_column_is_a_view_of_the_rows() -> None:
    law = ebac.EBAC()
    rows = law._simulate(ebac.Scenario(device=TWO, seconds=0.1).setup())
    trace = ebac.Trace.from_rows(rows, scenario=None, law="ebac", law_repr=repr(law))
    raw = rows.bytes()
    assert len(raw) == len(rows) * rows.row_bytes
    assert len(trace) == len(rows) == 101
    for name in trace:
        assert np.shares_memory(trace[name], raw), name
        assert np.shares_memory(trace.axis(name, 1), raw), name
        assert np.shares_memory(trace[0.02:0.05][name], raw), name


def test_columns_and_slices_are_read_only(trace: ebac.Trace) -> None:
    for part in (trace, trace[0.1:0.2]):
        for name in part:
            assert not part[name].flags.writeable, name
            with pytest.raises(ValueError, match=r"read-only"):
                part[name][0] = 0
            with pytest.raises(ValueError, match=r"WRITEABLE|writeable"):
                part[name].setflags(write=True)


def test_a_column_outlives_its_trace() -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.5), "tca")
    x, copy = trace["x"], trace["x"].copy()
    del trace
    gc.collect()
    for seed in range(5):
        ebac.simulate(ebac.Scenario(seconds=0.5, seed=seed), "direct")
    assert (x == copy).all()


# --- columns ---


def test_every_column_has_a_unit_and_a_meaning(trace: ebac.Trace) -> None:
    assert set(trace.columns) == set(trace)
    known = {"1", "s", "m", "m/s", "N", "N m", "N/m", "J", "A", "rad", "rad/s", "counts"}
    for name, info in trace.columns.items():
        assert info.name == name
        assert info.unit in known, name
        assert len(info.meaning) > 5, name
    assert {
        "t": "s",
        "x": "m",
        "f_env": "N",
        "work": "J",
        "tau": "N m",
        "true.energy": "J",
    }.items() <= {name: info.unit for name, info in trace.columns.items()}.items()


def test_what_a_law_reads_and_a_simulation_knows_is_recorded(trace: ebac.Trace) -> None:
    told = {f.name for f in ebac.Port.fields()} | {f"true.{f.name}" for f in ebac.ExactPlant(
        device=TWO, hand=ebac.Hand(), tick=1e-3).truth().fields()}  # fmt: skip
    assert told | {"tick", "t", "lateness", "fault", "counts", "q", "dq", "tau", "current"} <= set(
        trace
    )


def test_shapes_follow_the_number_of_axes(trace: ebac.Trace) -> None:
    whole = {"tick", "t", "lateness", "fault", "state", "limited", "skipped", "ramp"}
    for name in trace:
        several = trace.axes > 1 and name not in whole
        assert trace[name].shape == ((301, trace.axes) if several else (301,)), name
    if trace.axes == 2:
        assert (trace.axis("x", 1) == trace["x"][:, 1]).all()
        assert (trace["x"][:, 0] != trace["x"][:, 1]).any()
    assert (trace.axis("t", trace.axes - 1) == trace["t"]).all()


def test_types_are_those_of_the_core(trace: ebac.Trace) -> None:
    kinds = {
        "t": np.float64,
        "tick": np.int64,
        "counts": np.int64,
        "fault": np.uint32,
        "law.clamped": np.bool_,
    }
    for name, kind in kinds.items():
        assert trace[name].dtype == kind


def test_ticks_count_and_time_adds_up(trace: ebac.Trace) -> None:
    assert trace["tick"].tolist() == list(range(301))
    assert trace["t"][0] == 0
    assert trace["t"] == pytest.approx(trace["tick"] * 1e-3 + trace["lateness"], abs=1e-12)
    assert np.diff(trace["t"]) == pytest.approx(trace.axis("dt")[1:], abs=1e-12)
    assert 0.2e-3 < np.abs(trace["lateness"]).max() <= 0.3e-3


@pytest.mark.parametrize("axis", [-1, 2])
def test_an_axis_that_is_not_there_is_refused(axis: int, run: Any) -> None:
    with pytest.raises(ValueError, match=rf"axis = {axis}: must lie in \[0, 1\]"):
        run("ebac", device=TWO, seconds=0.1).axis("x", axis)


def test_an_unknown_column_of_another_program_says_what_reads_its_logs(tmp_path: Path) -> None:
    log = tmp_path / "foreign.csv"
    log.write_text("time,pos\n" + "".join(f"{k / 1000},0.01\n" for k in range(20)))
    said = "no column is called 'x'; there are: t, pos; ebac.identify.load reads logs of other programs$"
    with pytest.raises(KeyError, match=said):
        ebac.contact(ebac.load(log))


def test_an_unknown_column_lists_those_there_are(trace: ebac.Trace) -> None:
    assert "speed" not in trace
    with pytest.raises(KeyError, match=r"no column is called 'nonsense'; there are: tick, t, "):
        trace["nonsense"]


@pytest.mark.parametrize(
    ("word", "column"),
    [
        ("position", "'x'"),
        ("Speed", "'v'"),
        ("force", "'f_applied', 'f_cmd' or 'f_meas'"),
        ("time", "'t'"),
    ],
)
def test_a_column_is_found_by_its_word(word: str, column: str, trace: ebac.Trace) -> None:
    with pytest.raises(KeyError, match=f"no column is called '{word}', did you mean {column}; "):
        trace[word]


# --- slices of time ---


def test_a_slice_is_the_rows_between_two_times(trace: ebac.Trace) -> None:
    part = trace[0.1:0.2]
    inside = (trace["t"] >= 0.1) & (trace["t"] < 0.2)
    assert 95 < len(part) < 105
    for name in trace:
        assert part[name].tobytes() == trace[name][inside].tobytes()
    assert part.scenario == trace.scenario
    assert part.columns == trace.columns
    assert part.law == trace.law


def test_open_and_empty_slices(trace: ebac.Trace) -> None:
    assert len(trace[:]) == len(trace)
    assert len(trace[:0.1]) + len(trace[0.1:]) == len(trace)
    assert len(trace.rows(0, 0)) == 0
    assert "empty" in repr(trace.rows(0, 0))
    assert_same(trace.between(0.1, 0.2), trace[0.1:0.2])


def test_a_slice_has_no_step(trace: ebac.Trace) -> None:
    with pytest.raises(ValueError, match="without a step"):
        trace[0.0:0.1:2]


def test_a_slice_does_not_end_before_it_begins(trace: ebac.Trace) -> None:
    with pytest.raises(ValueError, match=r"stop = 0\.1 s: must be at least start, 0\.2 s"):
        trace[0.2:0.1]
    assert len(trace.between(0.1, 0.1)) == 0


@pytest.mark.parametrize(("start", "stop"), [(math.nan, None), (None, math.nan)])
def test_a_slice_begins_and_ends_at_a_number(
    trace: ebac.Trace, start: float | None, stop: float | None
) -> None:
    with pytest.raises(ValueError, match=r"(start|stop) = nan s: must be a time"):
        trace[start:stop]


def test_times_before_zero_are_sliced_as_others(tmp_path: Path) -> None:
    file = tmp_path / "early.csv"
    file.write_text("t [s],x [m]\n-0.5,1\n-0.4,2\n-0.3,3\n-0.2,4\n", encoding="utf-8")
    early = ebac.load(file)
    assert early[:]["x"].tolist() == [1, 2, 3, 4]
    for part in (early[:-0.25], ebac.load(file, stop=-0.25)):
        assert part["x"].tolist() == [1, 2, 3]
    with pytest.raises(ValueError, match=r"outside the run, which spans -0\.5 to -0\.2 s"):
        early[0.0:]


# --- exports ---


def test_pandas_holds_every_number_to_the_bit(trace: ebac.Trace) -> None:
    pytest.importorskip("pandas")
    frame = trace.to_pandas()
    assert frame.index.name == "t"
    assert frame.index.to_numpy().tobytes() == trace["t"].tobytes()
    for name, info, values in trace.flat():
        assert frame.attrs["units"][name] == info.unit
        if name != "t":
            assert frame[name].to_numpy().tobytes() == values.tobytes()
    assert ("x_1" in frame) == (trace.axes == 2)


def test_csv_and_back_holds_every_number_to_the_bit(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.to_csv(tmp_path / "run.csv")
    with (tmp_path / "run.csv").open(newline="") as file:
        headings, *rows = csv.reader(file)
    columns = list(trace.flat())
    assert len(headings) == len(columns)
    for i, (name, info, values) in enumerate(columns):
        assert headings[i] == (name if info.unit == "1" else f"{name} [{info.unit}]")
        kind = float if values.dtype == np.float64 else int
        read = np.array([kind(row[i]) for row in rows]).astype(values.dtype)
        assert read.tobytes() == values.tobytes(), name


def test_pandas_reads_the_csv(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.to_csv(tmp_path / "run.csv")
    frame = pytest.importorskip("pandas").read_csv(tmp_path / "run.csv")
    assert len(frame) == len(trace)
    assert frame["t [s]"].to_numpy() == pytest.approx(trace["t"])


def test_npz_and_back_is_the_same_trace(trace: ebac.Trace, tmp_path: Path) -> None:
    for part in (trace, trace[0.1:0.2]):
        part.to_npz(tmp_path / "run.npz")
        assert_same(ebac.Trace.from_npz(tmp_path / "run.npz"), part)


def test_npz_is_readable_by_numpy_alone(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.to_npz(tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz", allow_pickle=False) as archive:
        assert set(trace) <= set(archive)
        about = json.loads(str(archive["about"]))
        assert about["columns"]["x"] == ["m", trace.columns["x"].meaning]
        assert eval(about["law_repr"], PUBLIC).name == "ebac"


def test_npz_finds_the_file_it_wrote(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.to_npz(tmp_path / "run")
    assert len(ebac.Trace.from_npz(tmp_path / "run")) == len(trace)


def test_what_is_no_archive_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        ebac.Trace.from_npz(tmp_path / "none.npz")
    (tmp_path / "text.npz").write_text("no archive")
    np.savez(tmp_path / "other.npz", x=np.zeros(3))
    for name in ("text.npz", "other.npz"):
        with pytest.raises(ValueError, match=rf"{name}: not a trace written by to_npz"):
            ebac.Trace.from_npz(tmp_path / name)


@pytest.mark.slow
def test_html_is_a_table_of_the_columns(trace: ebac.Trace) -> None:
    html = trace._repr_html_()
    flat = list(trace.flat())
    assert html.count("<tr>") == len(flat) + 1
    for name, info, _ in flat:
        assert f"<th>{name}</th><td>{info.unit}</td>" in html
    assert "&lt;Trace of ebac: 301 rows" in html
    assert "<Trace" not in html


def test_html_of_an_empty_part_says_so(trace: ebac.Trace) -> None:
    assert "0 rows, empty" in trace.rows(0, 0)._repr_html_()


def test_repr_says_law_rows_and_time(run: Any) -> None:
    trace = run("eba", seconds=1.0)
    assert repr(trace) == "<Trace of eba: 1001 rows, 0 to 1 s, 1 axis>"


def test_a_trace_says_what_made_it(run: Any) -> None:
    trace = run("eba", seconds=1.0)
    assert trace.scenario == ebac.Scenario(seconds=1.0)
    assert trace.law == "eba"
    assert eval(trace.law_repr, PUBLIC) == ebac.design("eba", ebac.Device(), ebac.Timing())


def test_a_run_has_a_row_for_each_tick_and_one_for_the_start() -> None:
    for seconds, dt in ((0.1, 1e-3), (1e-3, 1e-3), (0.3, 1e-4), (1.0, 0.1)):
        scenario = ebac.Scenario(seconds=seconds, timing=ebac.Timing(dt=dt))
        trace = ebac.simulate(scenario, "eba")
        assert len(trace) == round(seconds / dt) + 1
        assert math.isclose(trace["t"][-1], seconds)


class Lagging:
    """A law without a text of its own."""

    name = "lagging"

    def __init__(self, share: float) -> None:
        self.share = share
        self.shape = abs  # whose text has no address, unlike that of a lambda
        self.other = lambda force: force
        self._last = 0.0

    def step(self, port: ebac.Port) -> float:
        self._last += self.share * (port.f_env - self._last)
        return self._last

    def reset(self) -> None:
        self._last = 0.0


def test_the_same_run_under_a_law_in_python_gives_the_same_file(tmp_path: Path) -> None:
    files = []
    for i in range(2):
        trace = ebac.simulate(ebac.Scenario(seconds=0.05), Lagging(0.3))
        assert trace.law_repr.startswith("Lagging(share=0.3, shape=<built-in function abs>, other=")
        assert " at 0x" not in trace.law_repr
        trace.save(tmp_path / f"{i}.mcap")
        files.append((tmp_path / f"{i}.mcap").read_bytes())
        replayed = ebac.replay(tmp_path / f"{i}.mcap", Lagging(0.3))
        assert replayed.law_repr == trace.law_repr
    assert files[0] == files[1]


def test_a_column_takes_a_list(trace: ebac.Trace) -> None:
    still = [0.0] * len(trace)
    assert (trace.with_column("t", still)["t"] == 0).all()
    with pytest.raises(ValueError, match=r"t: shape \(1,\), must be"):
        trace.with_column("t", [0.0])


@pytest.mark.parametrize("value", [None, "a", 1j])
def test_a_column_holds_numbers_alone(trace: ebac.Trace, value: Any) -> None:
    """With None it was saved as NPZ, which could not be read again."""
    with pytest.raises(TypeError, match=r"x: values of type .*, must be real numbers"):
        trace.with_column("x", np.array([value] * len(trace)))


def test_a_column_is_copied_and_cannot_be_written(trace: ebac.Trace) -> None:
    x = np.zeros(trace["x"].shape)
    other = trace.with_column("x", x)
    x[:] = 1.0
    assert not other["x"].any()
    with pytest.raises(ValueError, match="read-only"):
        other["x"][:] = 1.0
