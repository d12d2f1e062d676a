"""Logs: what is written is what is read, by ebac and by the official reader, whole, cut and repaired."""

import json
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import ebac
from ebac.logs import About, Event, Log, LogWriter, Recorder, read, repair
from ebac.logs.layout import Layout, LoggedColumn

TWO = ebac.Device(kinematics=ebac.Linear(axes=2))


@pytest.fixture(params=[1, 2], ids=["one axis", "two axes"])
def trace(request: pytest.FixtureRequest, run: Any) -> ebac.Trace:
    device = ebac.Device(
        kinematics=ebac.Linear(axes=request.param), sensor=ebac.ForceSensor(noise=0.1)
    )
    world = ebac.Corner() if request.param > 1 else ebac.Wall()
    traced = run("ebac", device=device, environment=world, seconds=0.3, jitter=0.3)
    assert isinstance(traced, ebac.Trace)
    return traced


def assert_same_rows(one: ebac.Trace, other: ebac.Trace, count: int | None = None) -> None:
    assert list(one) == list(other)
    for name in one:
        assert one[name].dtype == other[name].dtype, name
        assert one[name][:count].tobytes() == other[name][:count].tobytes(), name
    assert one.columns == other.columns
    assert (one.axes, one.law, one.law_repr, one.scenario) == (
        other.axes, other.law, other.law_repr, other.scenario,
    )  # fmt: skip


def written(
    path: Path, trace: ebac.Trace, chunk: int = 50, events: list[Event] | None = None
) -> Path:
    """A log in chunks of a known number of rows, the events in the second."""
    data = {name: trace[name] for name in trace}
    about = About(axes=trace.axes, law=trace.law, law_repr=trace.law_repr, scenario=trace.scenario)
    with LogWriter(path, layout=Layout.of(data, trace.columns), about=about) as log:
        for first in range(0, len(trace), chunk):
            part = {name: values[first : first + chunk] for name, values in data.items()}
            log.write(part, (events or []) if first == chunk else [])
    return path


# --- round trips ---


def test_a_log_is_the_trace_to_the_bit(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.save(tmp_path / "run.mcap")
    assert_same_rows(ebac.load(tmp_path / "run.mcap"), trace)
    assert_same_rows(ebac.Trace.load(tmp_path / "run.mcap"), trace)
    log = read(tmp_path / "run.mcap")
    assert log.condition.complete
    assert (log.condition.damaged, log.condition.bytes_left, log.gaps, log.lost) == (0, 0, [], 0)
    assert log.ended == {"rows": "301", "lost": "0"}
    assert log.about.made_by["ebac"] == ebac.__version__


def test_the_same_run_gives_the_same_file(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.save(tmp_path / "one.mcap")
    trace.save(tmp_path / "two.mcap")
    assert (tmp_path / "one.mcap").read_bytes() == (tmp_path / "two.mcap").read_bytes()


def test_the_columns_are_contiguous_and_read_only(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.save(tmp_path / "run.mcap")
    loaded = ebac.load(tmp_path / "run.mcap")
    for name in loaded:
        assert loaded[name].flags.c_contiguous
        assert not loaded[name].flags.writeable
    assert isinstance(loaded.plot(), object)


def test_an_empty_part_is_a_log_too(trace: ebac.Trace, tmp_path: Path) -> None:
    trace[:0.0].save(tmp_path / "none.mcap")
    log = read(tmp_path / "none.mcap")
    assert len(log.trace) == 0
    assert log.condition.complete
    assert list(log.trace) == list(trace)


@st.composite
def columns(draw: st.DrawFn) -> dict[str, np.ndarray[Any, Any]]:
    """Columns of any kind and any bits, NaN and infinities included."""
    rows, axes = draw(st.integers(0, 40)), draw(st.integers(1, 3))
    kinds = draw(st.lists(st.sampled_from(["f8", "i8", "i4", "u4", "?"]), max_size=6))
    random = np.random.default_rng(draw(st.integers(0, 2**32)))
    data: dict[str, np.ndarray[Any, Any]] = {
        "tick": np.arange(rows, dtype=np.int64),
        "t": np.arange(rows) * 1e-3,
    }
    for i, kind in enumerate(kinds):
        shape = (rows,) if axes == 1 or draw(st.booleans()) else (rows, axes)
        size = int(np.prod(shape)) * np.dtype(kind).itemsize
        raw = np.frombuffer(random.bytes(size), np.uint8)
        data[f"part.c{i}"] = (
            (raw & 1).astype(bool).reshape(shape) if kind == "?" else raw.view(kind).reshape(shape)
        )
    return data


@given(data=columns(), chunk=st.integers(1, 50))
@settings(deadline=None, max_examples=25)
def test_columns_of_any_kind_and_any_bits_come_back(
    data: dict[str, np.ndarray[Any, Any]], chunk: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    axes = max(values.shape[-1] if values.ndim == 2 else 1 for values in data.values())
    infos = {name: ebac.ColumnInfo(name=name, unit="m", meaning="a number") for name in data}
    trace = ebac.Trace(data=data, columns=infos, axes=axes)
    path = written(tmp_path_factory.mktemp("log") / "any.mcap", trace, chunk)
    assert_same_rows(read(path).trace, trace)


# --- the official reader ---


def ros2_values(schema: Any, data: bytes) -> dict[str, Any]:
    """Decode a flat message by its own definition, as a ROS 2 decoder does: by type, aligned."""
    import struct

    forms = {"float64": "d", "int64": "q", "int32": "i", "uint32": "I", "bool": "?"}
    assert data[:4] == b"\x00\x01\x00\x00"
    at, values = 0, {}
    for line in schema.data.decode().splitlines():
        if line.startswith("#"):
            continue
        kind, name = line.split("#")[0].split()
        kind, _, size = kind.partition("[")
        count = int(size[:-1]) if size else 1
        form = forms[kind]
        width = struct.calcsize(form)
        at = (at + width - 1) // width * width
        found = struct.unpack_from(f"<{count}{form}", data, 4 + at)
        values[name] = found if size else found[0]
        at += width * count
    assert 4 + at == len(data)
    return values


def official(path: Path) -> tuple[list[dict[str, Any]], list[Any], list[int]]:
    """Rows, events and times by the default reader of the `mcap` library, sums checked."""
    from mcap.reader import make_reader

    rows, events, times = [], [], []
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            assert schema is not None
            if channel.topic == "/ebac":
                assert (schema.encoding, channel.message_encoding) == ("ros2msg", "cdr")
                rows.append(ros2_values(schema, message.data))
                times.append(message.log_time)
                assert message.sequence == rows[-1]["tick"]
            else:
                assert channel.topic == "/ebac/events"
                events.append(json.loads(message.data))
    return rows, events, times


def assert_official(path: Path, trace: ebac.Trace) -> None:
    rows, _, times = official(path)
    assert len(rows) == len(trace)
    assert times == [round(1e9 * t) for t in trace["t"].tolist()]
    for i in (0, 1, len(trace) // 2, len(trace) - 1):
        for name in trace:
            value = trace[name][i]
            told = rows[i][name.replace(".", "_")]
            expected = tuple(value.tolist()) if value.ndim else value.item()
            assert told == expected or np.isnan(expected).all(), name


def test_the_official_reader_reads_every_number(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.save(tmp_path / "run.mcap")
    assert_official(tmp_path / "run.mcap", trace)


def test_the_official_reader_finds_summary_metadata_and_attachments(
    trace: ebac.Trace, tmp_path: Path
) -> None:
    from mcap.reader import NonSeekingReader, make_reader

    path = written(tmp_path / "run.mcap", trace)
    with path.open("rb") as file:
        reader = make_reader(file)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        assert summary.statistics.message_count == len(trace)
        assert summary.statistics.chunk_count == len(summary.chunk_indexes) == 7
        assert summary.statistics.message_end_time == round(1e9 * trace["t"][-1])
        told = {m.name: m.metadata for m in reader.iter_metadata()}
        assert told["ebac"]["law"] == "ebac"
        (scenario,) = reader.iter_attachments()
        assert ebac.Scenario.from_toml(scenario.data.decode()) == trace.scenario
        part = [
            m.log_time
            for _, _, m in reader.iter_messages(starting_at=10**8, ending_before=2 * 10**8)
        ]
        assert len(part) == np.count_nonzero((trace["t"] >= 0.1) & (trace["t"] < 0.2))
        file.seek(0)
        streamed = list(NonSeekingReader(file, validate_crcs=True).iter_messages())
        assert len(streamed) == len(trace)


def test_message_indexes_point_at_their_messages(trace: ebac.Trace, tmp_path: Path) -> None:
    from mcap.records import Chunk, Message, MessageIndex
    from mcap.stream_reader import StreamReader, breakup_chunk

    event = Event(kind="note", message="here", tick=60, t=0.06)
    path = written(tmp_path / "run.mcap", trace, events=[event])
    with path.open("rb") as file:
        records = list(StreamReader(file, emit_chunks=True).records)
    content, times, seen = b"", {}, 0
    for record in records:
        if isinstance(record, Chunk):
            messages = [m for m in breakup_chunk(record) if isinstance(m, Message)]
            import zstandard

            content = zstandard.ZstdDecompressor().decompress(record.data)
            times = {(m.channel_id, m.log_time) for m in messages}
        elif isinstance(record, MessageIndex):
            for time, offset in record.records:
                assert content[offset] == 0x05
                assert (
                    int.from_bytes(content[offset + 9 : offset + 11], "little") == record.channel_id
                )
                assert int.from_bytes(content[offset + 15 : offset + 23], "little") == time
                assert (record.channel_id, time) in times
                seen += 1
    assert seen == len(trace) + 1


def test_every_field_has_its_unit_and_its_meaning(trace: ebac.Trace, tmp_path: Path) -> None:
    text = Layout.of({n: trace[n] for n in trace}, trace.columns).ros2msg()
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    assert len(lines) == len(list(trace))
    for name, info in trace.columns.items():
        field = name.replace(".", "_")
        (line,) = [line for line in lines if line.split()[1] == field]
        assert line.endswith(f"# [{info.unit}] {info.meaning}")


def test_events_are_read_by_both(trace: ebac.Trace, tmp_path: Path) -> None:
    events = [
        Event(kind="parameter", message="damping raised", tick=60, t=0.06, values={"damping_Ns_per_m": 40.0}),
        Event(kind="fault", message="fault 4", tick=61, t=0.061, values={"fault": 4}),
    ]  # fmt: skip
    path = written(tmp_path / "run.mcap", trace, events=events)
    log = read(path)
    assert log.events == events
    assert_same_rows(log.trace, trace)
    _, told, _ = official(path)
    assert [event["name"] for event in told] == ["parameter", "fault"]
    assert [event["level"] for event in told] == [2, 5]
    assert told[0]["timestamp"] == {"sec": 0, "nsec": 60_000_000}


# --- cut, damaged, repaired ---


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, ebac.Trace, list[int]]:
    """A log of 12 chunks of 10 rows, its trace, and where each chunk ends."""
    from mcap.records import Chunk
    from mcap.stream_reader import StreamReader

    trace = ebac.simulate(ebac.Scenario(seconds=0.119), "ebac")
    path = tmp_path_factory.mktemp("small") / "small.mcap"
    written(path, trace, 10, [Event(kind="note", message="here", tick=11, t=0.011)])
    whole = path.read_bytes()
    ends, at = [], 8
    while whole[at] != 0x0F:
        length = int.from_bytes(whole[at + 1 : at + 9], "little")
        at += 9 + length
        if whole[at - 9 - length] == 0x06:
            ends.append(at)
    with path.open("rb") as file:
        assert sum(isinstance(r, Chunk) for r in StreamReader(file, emit_chunks=True).records) == 12
    assert len(ends) == 12
    return whole, trace, ends


def cut_log(folder: Path, data: bytes) -> Path:
    path = folder / "cut.mcap"
    path.write_bytes(data)
    return path


def readable(path: Path) -> Log | None:
    """The log, or None where it is refused by its name; anything else fails the test."""
    try:
        return read(path)
    except ValueError as error:
        if not str(error).startswith(f"{path}: "):
            raise
        return None


@given(data=st.data())
@settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_a_log_cut_at_any_byte_loses_its_last_chunk_at_most(
    small: tuple[bytes, ebac.Trace, list[int]], tmp_path: Path, data: st.DataObject
) -> None:
    whole, trace, ends = small
    size = data.draw(st.integers(0, len(whole) - 1))
    path = cut_log(tmp_path, whole[:size])
    log = readable(path)
    if log is None:
        assert size < ends[0]
        return
    chunks = sum(end <= size for end in ends)
    assert len(log.trace) == 10 * chunks
    assert not log.condition.complete
    assert log.condition.damaged == 0
    assert log.trace["x"].tobytes() == trace["x"][: 10 * chunks].tobytes()
    assert len(log.events) == (chunks > 1)


@given(data=st.data())
@settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_damage_at_any_place_never_crashes_the_reader(
    small: tuple[bytes, ebac.Trace, list[int]], tmp_path: Path, data: st.DataObject
) -> None:
    whole, trace, _ = small
    broken = bytearray(whole)
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(whole) - 1))
        some = data.draw(st.binary(min_size=1, max_size=12))
        broken[at : at + len(some)] = some
    log = readable(cut_log(tmp_path, bytes(broken)))
    if log is None:
        return
    assert len(log.trace) <= len(trace)
    known = set(trace["x"].tolist())
    assert set(log.trace["x"].tolist() if "x" in log.trace else []) <= known


@given(st.binary(max_size=300))
@settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@example(b"")
@example(b"\x89MCAP0\r\n")
@example(b"\x89MCAP0\r\n\x89MCAP0\r\n")
def test_what_is_no_log_is_refused_by_name(tmp_path: Path, data: bytes) -> None:
    for start in (b"", b"\x89MCAP0\r\n"):
        with pytest.raises(ValueError, match=r"cut\.mcap: "):
            read(cut_log(tmp_path, start + data))


def test_a_damaged_chunk_is_left_out_and_the_others_are_read(
    small: tuple[bytes, ebac.Trace, list[int]], tmp_path: Path
) -> None:
    whole, trace, ends = small
    broken = bytearray(whole)
    broken[ends[3] - 20] ^= 0xFF
    log = read(cut_log(tmp_path, bytes(broken)))
    assert log.condition.complete
    assert log.condition.damaged == 1
    assert "a chunk at byte" in log.condition.remarks[0]
    assert log.trace["tick"].tolist() == [*range(30), *range(40, 120)]
    (gap,) = log.gaps
    assert (gap.after_tick, gap.rows, log.lost) == (29, 10, 10)
    assert gap.t == trace["t"][29]


@given(data=st.data())
@pytest.mark.slow
@settings(
    deadline=None, max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_a_repaired_log_is_read_by_the_official_reader(
    small: tuple[bytes, ebac.Trace, list[int]], tmp_path: Path, data: st.DataObject
) -> None:
    whole, trace, ends = small
    size = data.draw(st.integers(ends[0], len(whole) - 1))
    path = cut_log(tmp_path, whole[:size])
    (tmp_path / "cut.repaired.mcap").unlink(missing_ok=True)
    log = repair(path)
    assert log.path == tmp_path / "cut.repaired.mcap"
    assert log.condition.complete
    count = 10 * sum(end <= size for end in ends)
    assert_same_rows(log.trace, trace[: (count - 0.5) * 1e-3])
    assert_official(log.path, log.trace)
    assert path.read_bytes() == whole[:size]
    assert log.events == read(path).events


def test_a_log_without_a_row_is_not_repaired(
    small: tuple[bytes, ebac.Trace, list[int]], tmp_path: Path
) -> None:
    whole, _, ends = small
    path = cut_log(tmp_path, whole[: ends[0] - 1])
    with pytest.raises(ValueError, match="nothing can be recovered: no row"):
        repair(path)
    assert not (tmp_path / "cut.repaired.mcap").exists()


def test_repair_never_writes_over_anything(
    small: tuple[bytes, ebac.Trace, list[int]], tmp_path: Path
) -> None:
    path = cut_log(tmp_path, small[0][:-20])
    other = tmp_path / "other.mcap"
    other.write_text("mine")
    for out in (other, path):
        with pytest.raises(FileExistsError):
            repair(path, out)
    assert other.read_text() == "mine"
    with pytest.raises(ValueError, match="not an MCAP"):
        repair(other)
    assert not (tmp_path / "other.repaired.mcap").exists()


def test_a_log_that_exists_is_not_written_over(trace: ebac.Trace, tmp_path: Path) -> None:
    (tmp_path / "run.mcap").write_text("mine")
    with pytest.raises(FileExistsError):
        written(tmp_path / "run.mcap", trace)
    assert (tmp_path / "run.mcap").read_text() == "mine"


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["tick", "t", "a.b", "a_b"], "cannot be distinguished in a log"),
        (["tick", "x"], "the columns t and tick are those"),
    ],
)
def test_columns_that_cannot_be_logged_are_refused(names: list[str], message: str) -> None:
    made = tuple(LoggedColumn(name=n, unit="1", meaning="", kind="float64", size=1) for n in names)
    with pytest.raises(ValueError, match=message):
        Layout.from_json(json.dumps([vars(column) for column in made]))
    data = {name: np.zeros(3, complex) for name in ("t", "tick")}
    infos = {name: ebac.ColumnInfo(name=name, unit="1", meaning="") for name in data}
    with pytest.raises(ValueError, match=r"column t: complex128 .* cannot be logged"):
        Layout.of(data, infos)


# --- the recorder ---


def rows_of(seconds: float = 1.0, **changes: Any) -> Any:
    return ebac.EBAC()._simulate(ebac.Scenario(seconds=seconds, **changes).setup())


def fed(source: Any, target: Any, count: int, start: int = 0) -> None:
    _, raw = source.copy(start, count)
    for row in raw.reshape(-1, source.row_bytes):
        target.append(row)


@pytest.mark.parametrize("ring", [False, True], ids=["fixed", "ring"])
def test_a_recorder_writes_every_row_of_a_growing_trace(ring: bool, tmp_path: Path) -> None:
    source = rows_of()
    rows = source.empty_like(2000, ring=ring)
    with Recorder(rows, tmp_path / "run.mcap", law="ebac", start=0.0, interval=0.001) as recorder:
        for first in range(0, 1000, 100):
            fed(source, rows, first + 100, first)
            recorder.event("parameter", "changed", gain=first)
    assert (recorder.written, recorder.lost, recorder.error) == (1000, 0, None)
    log = read(tmp_path / "run.mcap")
    whole = ebac.Trace.from_rows(source, scenario=None, law="ebac", law_repr="")
    assert_same_rows(log.trace, whole[:0.9995])
    assert [event.values for event in log.events] == [{"gain": n} for n in range(0, 1000, 100)]
    assert_official(tmp_path / "run.mcap", log.trace)


def test_an_event_stands_at_the_time_of_its_tick(tmp_path: Path) -> None:
    """It stood at that of the last row, and was missing in a part of the log."""
    source = rows_of(jitter=0.1)
    rows = source.empty_like(2000)
    with Recorder(rows, tmp_path / "run.mcap", interval=0.001) as recorder:
        fed(source, rows, 1000)
        wait_until(lambda: recorder.written == 1000)
        for tick in (100, 999, 5000):
            recorder.event("note", "seen", tick=tick)
    log = read(tmp_path / "run.mcap")
    t = log.trace["t"]
    assert [event.t for event in log.events] == [t[100], t[999], t[999]]
    assert [event.tick for event in read(tmp_path / "run.mcap", stop=0.2).events] == [100]


@pytest.mark.parametrize(
    ("value", "read_as"),
    [
        (np.int64(5), 5),
        (np.float32(1.5), 1.5),
        (np.bool_(True), True),
        (np.array([1, 2]), [1, 2]),
    ],
)
def test_a_number_of_numpy_in_an_event_is_a_number(
    value: Any, read_as: Any, tmp_path: Path
) -> None:
    """It ended the recording, and with it the run."""
    rows = rows_of(0.1)
    with Recorder(rows, tmp_path / "run.mcap") as recorder:
        recorder.event("note", "measured", value=value)
        with pytest.raises(TypeError, match=r"event: value = .* \(object\): a log takes what JSON"):
            recorder.event("note", "measured", value=object())
    (event,) = read(tmp_path / "run.mcap").events
    assert event.values == {"value": read_as}


def test_a_recorder_may_begin_with_a_later_row(tmp_path: Path) -> None:
    rows = rows_of()
    with Recorder(rows, tmp_path / "run.mcap", first=600) as recorder:
        pass
    assert (recorder.written, recorder.lost) == (401, 0)
    assert read(tmp_path / "run.mcap").trace["tick"][0] == 600


def test_what_comes_while_a_chunk_is_written_waits_for_the_next(tmp_path: Path) -> None:
    source = rows_of()
    rows = source.empty_like(2000)
    calls = 0

    def grow() -> list[Event]:  # as a loop at 10 kHz: some rows more whenever somebody looks
        nonlocal calls
        calls += 1
        if rows.count < 900:
            fed(source, rows, rows.count + 3, rows.count)
        return []

    begun = time.monotonic()
    with Recorder(rows, tmp_path / "run.mcap", watch=grow, interval=0.02) as recorder:
        wait_until(lambda: recorder.written > 30)
    assert calls <= (time.monotonic() - begun) / 0.02 + 1  # one more at the end
    assert recorder.written == rows.count


def test_a_recorder_asks_for_events(tmp_path: Path) -> None:
    waiting = [Event(kind="parameter", message=f"change {i}", tick=i, t=1e-3 * i) for i in range(5)]
    told = list(waiting)
    with Recorder(
        rows_of(0.1), tmp_path / "run.mcap", interval=0.001,
        watch=lambda: [waiting.pop(0)] if waiting else [],
    ):  # fmt: skip
        wait_until(lambda: not waiting)
    assert read(tmp_path / "run.mcap").events == told


def test_a_watch_that_raises_ends_the_recording_and_is_reported(tmp_path: Path) -> None:
    def broken() -> list[Event]:
        raise RuntimeError("no answer")

    recorder = Recorder(rows_of(0.1), tmp_path / "run.mcap", watch=broken)
    with pytest.raises(OSError, match="recording stopped after 0 rows: no answer"):
        recorder.close()


def test_a_ring_keeps_the_last_rows_and_the_log_has_all(tmp_path: Path) -> None:
    source = rows_of()
    rows = source.empty_like(64, ring=True)
    with Recorder(rows, tmp_path / "run.mcap", interval=0.001) as recorder:
        for first in range(0, 960, 32):
            fed(source, rows, first + 32, first)
            wait_until(lambda count=first + 32: recorder.written == count)
    assert (len(rows), rows.count, rows.first) == (64, 960, 896)
    last = ebac.Trace.from_rows(rows, scenario=None, law="", law_repr="")
    assert last["tick"].tolist() == list(range(896, 960))
    assert read(tmp_path / "run.mcap").trace["tick"].tolist() == list(range(960))


def wait_until(true: Callable[[], bool]) -> None:
    end = time.monotonic() + 60
    while not true():
        assert time.monotonic() < end, "it never came"
        time.sleep(0.001)


def test_rows_a_ring_has_written_over_are_counted_and_reported(tmp_path: Path) -> None:
    source = rows_of()
    rows = source.empty_like(100, ring=True)
    recorder = Recorder(rows, tmp_path / "run.mcap", interval=10)
    fed(source, rows, 350)
    with pytest.warns(UserWarning, match=r"250 rows were lost"):
        recorder.close()
    assert (recorder.written, recorder.lost) == (100, 250)
    log = read(tmp_path / "run.mcap")
    assert log.trace["tick"].tolist() == list(range(250, 350))
    (event,) = log.events
    assert (event.kind, event.tick, event.values) == ("lost", 250, {"rows": 250})
    assert log.ended == {"rows": "100", "lost": "250"}


def test_a_fault_is_an_event(tmp_path: Path) -> None:
    class Broken:
        def step(self, port: ebac.Port) -> float:
            return float("nan") if port.x > 0 else 0.0

        def reset(self) -> None: ...

    with pytest.raises(ebac.LoopFault) as stopped:
        ebac.simulate(ebac.Scenario(seconds=1), Broken())
    source = ebac._core._simulate_python(ebac.Scenario(seconds=1).setup(), Broken())
    with Recorder(source, tmp_path / "run.mcap"):
        pass
    log = read(tmp_path / "run.mcap")
    tick = int((stopped.value.trace["fault"] != 0).argmax())
    (event,) = log.events
    assert (event.kind, event.tick, event.message) == ("fault", tick, "fault 4 (law not finite)")
    assert log.faults == [(4, float(log.trace["t"][tick]), tick)]


FULL = """
import resource, sys, time
import ebac
from ebac.logs import Recorder
source = ebac.EBAC()._simulate(ebac.Scenario(seconds=1).setup())
rows = source.empty_like(2000)
recorder = Recorder(rows, sys.argv[1], interval=0.001)
resource.setrlimit(resource.RLIMIT_FSIZE, (30_000, 30_000))  # bytes
for row in source.copy(0, 1000)[1].reshape(-1, source.row_bytes):
    rows.append(row)
    time.sleep(0.0002)
while recorder.error is None:
    time.sleep(0.001)
recorder.close()
"""


def test_a_file_that_takes_no_more_ends_the_recording_and_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    done = subprocess.run(
        [sys.executable, "-c", FULL, str(path)], check=False, capture_output=True, text=True
    )
    assert done.returncode == 1
    told = re.search(r"recording stopped after (\d+) rows: .*File too large", done.stderr)
    assert told, done.stderr
    log = read(path)
    assert 0 < len(log.trace) == int(told[1]) < 1000
    assert log.trace["tick"].tolist() == list(range(len(log.trace)))
    assert (log.condition.complete, log.condition.bytes_left) == (False, 0)
    assert repair(path).condition.complete


def test_a_recorder_refuses_what_it_cannot_do(tmp_path: Path) -> None:
    rows = rows_of(0.1)
    with pytest.raises(ValueError, match=r"Recorder.interval = 0 s: must lie in \[0.001, 10\] s"):
        Recorder(rows, tmp_path / "run.mcap", interval=0)
    with pytest.raises(ValueError, match=r"Recorder.sync = 0.01 s"):
        Recorder(rows, tmp_path / "run.mcap", sync=0.01)
    assert not (tmp_path / "run.mcap").exists()
    with Recorder(rows, tmp_path / "run.mcap", sync=0.1) as recorder:
        pass
    with pytest.raises(ValueError, match="closed"):
        recorder.event("note", "too late")
    with pytest.raises(FileExistsError):
        Recorder(rows, tmp_path / "run.mcap")
    recorder.close()
    assert "closed, 101 rows, 0 lost" in repr(recorder)


def test_a_log_holds_configuration_and_its_time(tmp_path: Path) -> None:
    source = rows_of(0.1)
    scenario = ebac.Scenario(seconds=0.1)
    with Recorder(
        source, tmp_path / "run.mcap", scenario=scenario, law="ebac", law_repr="EBAC()",
        files={"joystick.toml": "[drive]\n"}, start=1e9,
    ):  # fmt: skip
        pass
    log: Log = read(tmp_path / "run.mcap")
    assert log.about.files == {"joystick.toml": "[drive]\n"}
    assert log.trace.scenario == log.about.scenario == scenario
    assert log.about.start_ns == 10**18
    assert official(tmp_path / "run.mcap")[2][:2] == [10**18, 10**18 + 10**6]


# --- rows of the core as a ring ---


@given(capacity=st.integers(1, 40), count=st.integers(0, 120), data=st.data())
@settings(deadline=None, max_examples=60)
def test_a_ring_gives_what_it_has_and_says_what_is_gone(
    capacity: int, count: int, data: st.DataObject
) -> None:
    source = SOURCE
    ring = source.empty_like(capacity, ring=True)
    fed(source, ring, count)
    kept = min(count, capacity)
    assert (ring.count, len(ring), ring.first) == (count, kept, count - kept)
    start = data.draw(st.integers(0, count))
    stop = data.draw(st.integers(start, count))
    first, raw = ring.copy(start, stop)
    assert first == min(max(start, ring.first), stop)
    assert raw.tobytes() == source.copy(first, stop)[1].tobytes()
    assert ring.bytes().tobytes() == source.copy(count - kept, count)[1].tobytes()


SOURCE = rows_of(0.12)


def test_rows_refuse_what_does_not_fit() -> None:
    rows = SOURCE.empty_like(2)
    row = SOURCE.copy(0, 1)[1]
    with pytest.raises(ValueError, match=r"3 bytes: a row has"):
        rows.append(row[:3])
    rows.append(row)
    rows.append(row)
    with pytest.raises(IndexError, match="full with 2 rows"):
        rows.append(row)
    with pytest.raises(IndexError, match="rows 1 to 3: the trace has had 2"):
        rows.copy(1, 3)
    with pytest.raises(ValueError, match="must be at least 1"):
        SOURCE.empty_like(0)


def test_a_part_after_a_change_was_changed(tmp_path: Path) -> None:
    """It was judged as if law and world were those of the start, and exported so."""
    trace = ebac.simulate(ebac.Scenario(seconds=0.3), "direct")
    moved = ebac.logs.Event(
        kind="parameter", message="environment: stiffness 10000 -> 20000", tick=100, t=0.1
    )
    path = written(tmp_path / "run.mcap", trace, chunk=100, events=[moved])
    for start, changed in ((None, True), (0.2, True)):
        part = ebac.load(path, start=start)
        assert part.changed is changed
        assert ebac.contact(part).exact is None
        with pytest.warns(UserWarning, match="were changed while this log was recorded"):
            ebac.replay(part, "direct")
    assert not ebac.load(path, stop=0.1).changed


def test_a_recorder_whose_end_was_interrupted_can_be_ended(tmp_path: Path) -> None:
    """The second call did nothing: the last rows and the summary were lost, and the file stayed open."""
    recorder = Recorder(rows_of(), tmp_path / "run.mcap", interval=10.0)
    join = recorder._threads[0].join
    interrupts = iter([KeyboardInterrupt])

    def interrupted(*args: Any) -> None:
        for error in interrupts:
            raise error
        join(*args)

    recorder._threads[0].join = interrupted  # type: ignore[method-assign]
    with pytest.raises(KeyboardInterrupt):
        recorder.close()
    recorder.close()
    log = read(tmp_path / "run.mcap")
    assert len(log.trace) == recorder.written > 0
    assert log.condition.complete


def test_an_event_of_a_tick_that_a_ring_has_lost_has_the_last_time_that_was_read(
    tmp_path: Path,
) -> None:
    """It raised an `IndexError` of the rows."""
    ring = SOURCE.empty_like(10, True)
    with Recorder(ring, tmp_path / "run.mcap", interval=10.0) as recorder:
        for row in range(20):
            ring.append(SOURCE.copy(row, row + 1)[1])
        recorder._take_all()
        for row in range(20, 60):
            ring.append(SOURCE.copy(row, row + 1)[1])
        recorder.event("note", "late", tick=15)
        with pytest.warns(UserWarning, match="40 rows were lost"):
            recorder.close()
    event = next(e for e in read(tmp_path / "run.mcap").events if e.kind == "note")
    assert (event.tick, event.t) == (15, pytest.approx(0.019))


def test_an_event_of_a_recorder_that_is_closed_meanwhile_is_refused(tmp_path: Path) -> None:
    """It was taken and never written."""
    recorder = Recorder(rows_of(), tmp_path / "run.mcap", interval=10.0)
    time_of = recorder._new.time_of

    def closed(tick: int) -> float:  # as another thread does
        recorder.close()
        return time_of(tick)

    recorder._new.time_of = closed  # type: ignore[method-assign]
    with pytest.raises(ValueError, match="the recorder is closed"):
        recorder.event("note", "too late", tick=3)
