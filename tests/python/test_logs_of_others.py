"""Logs that other programs wrote anew, damaged or made to hurt; parts of large ones."""

import json
import struct
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zstandard
from hypothesis import given
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap.records import Chunk
from mcap.writer import CompressionType, Writer
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.logs import About, Event, LogWriter, read
from ebac.logs.layout import Layout
from ebac.logs.records import MAGIC
from ebac.logs.summary import described, record_bytes
from ebac.logs.ticks import ticks_of

runner = CliRunner()
EVENTS = [Event(kind="note", message=f"note {i}", tick=10 * i, t=0.01 * i) for i in range(5)]


@pytest.fixture
def trace(run: Any) -> ebac.Trace:
    traced = run("ebac", seconds=0.3)
    assert isinstance(traced, ebac.Trace)
    return traced


def logged(path: Path, trace: ebac.Trace) -> Path:
    """A log with rows and events in turn."""
    data = {name: trace[name] for name in trace}
    about = About(axes=trace.axes, law=trace.law, law_repr=trace.law_repr, scenario=trace.scenario)
    with LogWriter(path, layout=Layout.of(data, trace.columns), about=about) as log:
        for i, first in enumerate(range(0, len(trace), 50)):
            part = {name: values[first : first + 50] for name, values in data.items()}
            log.write(part, EVENTS[i : i + 1])
    return path


def rewritten(path: Path, out: Path, **options: Any) -> Path:
    """A log as a program with the official library copies it: its own numbers of channels, its own chunks."""
    with path.open("rb") as file, out.open("wb") as new:
        reader = make_reader(file)
        writer = Writer(new, **options)
        writer.start(profile="", library="somebody else's")
        numbers: dict[int, int] = {}
        for number in range(7):  # schemas and channels of other things come first
            writer.register_schema(f"other{number}", "jsonschema", b"{}")
        for schema, channel, message in reader.iter_messages():
            assert schema is not None
            if channel.id not in numbers:
                kind = writer.register_schema(schema.name, schema.encoding, schema.data)
                numbers[channel.id] = writer.register_channel(
                    channel.topic, channel.message_encoding, kind, dict(channel.metadata)
                )
            writer.add_message(
                numbers[channel.id], message.log_time, message.data, message.publish_time,
                message.sequence,
            )  # fmt: skip
        for record in reader.iter_metadata():
            writer.add_metadata(record.name, record.metadata)
        for file_ in reader.iter_attachments():
            writer.add_attachment(
                file_.create_time, file_.log_time, file_.name, file_.media_type, file_.data
            )
        writer.finish()
    return out


@pytest.mark.parametrize(
    "options",
    [
        pytest.param({}, id="one chunk"),
        pytest.param({"chunk_size": 100}, id="a chunk for each row"),
        pytest.param({"chunk_size": 20_000, "compression": CompressionType.LZ4}, id="lz4"),
        pytest.param({"chunk_size": 20_000, "compression": CompressionType.NONE}, id="not packed"),
        pytest.param({"use_chunking": False}, id="no chunks"),
        pytest.param({"repeat_channels": False, "repeat_schemas": False}, id="no summary"),
    ],
)
def test_a_log_written_anew_by_the_official_library_is_read(
    trace: ebac.Trace, tmp_path: Path, options: dict[str, Any]
) -> None:
    old = read(logged(tmp_path / "run.mcap", trace))
    new = read(rewritten(old.path, tmp_path / "new.mcap", **options))
    assert new.condition.complete
    assert (new.condition.damaged, new.condition.remarks) == (0, [])
    for name in old.trace:
        assert new.trace[name].tobytes() == old.trace[name].tobytes(), name
    assert new.events == old.events == EVENTS
    assert (new.trace.scenario, new.trace.law) == (old.trace.scenario, old.trace.law)


def test_one_written_anew_and_cut_is_read_to_the_cut(trace: ebac.Trace, tmp_path: Path) -> None:
    old = read(logged(tmp_path / "run.mcap", trace))
    path = rewritten(old.path, tmp_path / "new.mcap", chunk_size=10_000)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    log = read(path)
    assert not log.condition.complete
    assert log.condition.damaged == 0
    assert 0 < len(log.trace) < len(trace)
    assert log.trace["x"].tobytes() == trace["x"][: len(log.trace)].tobytes()
    assert log.events == EVENTS[: len(log.events)] != []


# --- parts ---


@pytest.mark.parametrize("extension", [".mcap", ".npz"])
def test_a_part_is_what_a_slice_of_the_whole_is(
    trace: ebac.Trace, tmp_path: Path, extension: str
) -> None:
    path = tmp_path / f"run{extension}"
    trace.save(path)
    for start, stop in ((0.1, 0.2), (None, 0.05), (0.25, None), (0.1, 0.1)):
        part, asked = read(path, start=start, stop=stop).trace, trace.between(start, stop)
        for name in asked:
            assert part[name].tobytes() == asked[name].tobytes(), name
        assert ebac.load(path, start=start, stop=stop)["t"].tolist() == asked["t"].tolist()
    for start, stop, told in ((5, None, "from 5 s"), (None, -1, "before -1 s")):
        with pytest.raises(ValueError, match=f"no rows {told}: the log has 0 to 0.3 s"):
            read(path, start=start, stop=stop)
    for one in (read, ebac.load):
        with pytest.raises(ValueError, match=r"stop = 0\.1 s: must be at least start, 0\.2 s"):
            one(path, start=0.2, stop=0.1)


def test_a_part_has_the_events_of_its_time(trace: ebac.Trace, tmp_path: Path) -> None:
    log = read(logged(tmp_path / "run.mcap", trace), start=0.015, stop=0.035)
    assert log.events == EVENTS[2:4]


PEAK = """
import resource, sys, ebac, ebac.logs.reader, zstandard, mcap.records
from pathlib import Path
def most():
    (line,) = [l for l in Path("/proc/self/status").read_text().splitlines() if "VmHWM" in l]
    return int(line.split()[1]) * 1024
ebac.load(sys.argv[2])
before = most()
part = dict(start=float(sys.argv[3]), stop=float(sys.argv[4])) if len(sys.argv) > 3 else {}
trace = ebac.load(sys.argv[1], **part)
print(most() - before, sum(trace[name].nbytes for name in trace))
"""


def peak(*arguments: Any) -> tuple[int, int]:
    command = [sys.executable, "-c", PEAK, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    most, asked = done.stdout.split()
    return int(most), int(asked)


def large(path: Path, trace: ebac.Trace, rows: int) -> Path:
    """A log of many rows that do not pack well."""
    noise = np.random.default_rng(1)
    first = {name: np.resize(trace[name], (rows, *trace[name].shape[1:])) for name in trace}
    first["t"], first["tick"] = np.arange(rows) * 1e-3, np.arange(rows)
    for name, values in first.items():
        if values.dtype == np.float64 and name != "t":
            first[name] = noise.standard_normal(values.shape)
    ebac.Trace(data=first, columns=trace.columns, axes=trace.axes).save(path)
    return path


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.slow
@pytest.mark.weekly
def test_memory_is_that_of_the_part_asked_for(trace: ebac.Trace, tmp_path: Path) -> None:
    path = large(tmp_path / "large.mcap", trace, 100_000)
    trace.save(tmp_path / "small.mcap")
    whole, asked = peak(path, tmp_path / "small.mcap")
    assert whole < 1.5 * asked
    few, _ = peak(path, tmp_path / "small.mcap", 50, 50.01)
    assert (
        few < 0.8 * asked < asked < whole
    )  # of it some 19 MB are under way, however large the log


# --- damage and bombs ---


def damaged(path: Path) -> Path:
    """A log with one byte of its second chunk turned."""
    whole = bytearray(path.read_bytes())
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    second = summary.chunk_indexes[1]
    whole[second.chunk_start_offset + second.chunk_length - 20] ^= 0xFF
    path.write_bytes(bytes(whole))
    return path


def test_load_warns_of_damage(trace: ebac.Trace, tmp_path: Path) -> None:
    path = damaged(logged(tmp_path / "run.mcap", trace))
    with pytest.warns(UserWarning, match=r"run.mcap: 1 damaged part left out: a chunk at byte"):
        loaded = ebac.load(path)
    assert len(loaded) == len(trace) - 50


def test_load_warns_of_a_log_that_was_cut(trace: ebac.Trace, tmp_path: Path) -> None:
    path = logged(tmp_path / "run.mcap", trace)
    assert len(ebac.load(path)) == len(trace)  # without a warning
    path.write_bytes(path.read_bytes()[:-30])
    with pytest.warns(
        UserWarning, match=rf"run\.mcap: was cut, .* {len(trace)} whole rows read\."
    ) as told:
        assert len(ebac.load(path)) == len(trace)
    assert f"`ebac log repair {path}`" in str(told[0].message)


def test_every_command_reports_damage(
    trace: ebac.Trace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    damaged(logged(Path("run.mcap"), trace))
    for words in ("info run.mcap", "export run.mcap a.csv", "plot run.mcap"):
        done = runner.invoke(app, ["log", *words.split()])
        assert done.exit_code == 3, done.output
        assert "1 damaged part left out" in done.output.replace("\n", " ")
    assert len(ebac.load("a.csv")) == len(trace) - 50
    done = runner.invoke(app, ["log", "export", "run.mcap", "b.csv", "--json"])
    assert done.exit_code == 3
    document = json.loads(done.stdout)
    assert (document["complete"], document["damaged"]) == (True, 1)
    assert "a chunk at byte" in document["remarks"][0]


def bomb(path: Path, trace: ebac.Trace, size: int, packed: bytes) -> Path:
    layout = Layout.of({name: trace[name] for name in trace}, trace.columns)
    chunk = Chunk(
        compression="zstd",
        data=packed,
        message_end_time=0,
        message_start_time=0,
        uncompressed_crc=0,
        uncompressed_size=size,
    )
    head = MAGIC + b"".join(map(record_bytes, described(layout)))
    path.write_bytes(head + 200 * record_bytes(chunk))
    return path


def test_a_small_file_never_unpacks_to_a_large_one(trace: ebac.Trace, tmp_path: Path) -> None:
    size = 1 << 26
    packed = zstandard.ZstdCompressor(level=3).compress(bytes(size))
    path = bomb(tmp_path / "bomb.mcap", trace, size, packed)
    assert path.stat().st_size < 2e6  # of 12.8 GB
    trace.save(tmp_path / "small.mcap")
    log = read(path)
    assert (len(log.trace), log.condition.damaged) == (0, 200)
    assert "67108864 bytes for" in log.condition.remarks[0]


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.slow
@pytest.mark.weekly
def test_chunks_that_unpack_to_much_are_unpacked_few_at_a_time(
    trace: ebac.Trace, tmp_path: Path
) -> None:
    size = 1 << 24
    random = np.random.default_rng(1).bytes(size // 500)
    message = struct.pack("<BQH", 5, size - 9, 99)  # one message of another channel
    packed = zstandard.ZstdCompressor().compress((message + random).ljust(size, b"\0"))
    assert size < 1000 * len(packed)
    path = bomb(tmp_path / "bomb.mcap", trace, size, packed)
    trace.save(tmp_path / "small.mcap")
    most, _ = peak(path, tmp_path / "small.mcap")
    assert most < 160e6  # of 3.4 GB


# --- tables of other programs, without a column of ticks ---


@pytest.fixture
def table(tmp_path: Path) -> Path:
    """100 rows at 997 Hz of which ten are lost, after the 40th."""
    rows = [f"{i / 997:.6f},{i},{0.1 * i:.3f}" for i in range(110) if not 40 <= i < 50]
    file = tmp_path / "mine.csv"
    file.write_text("t [s],x [mm],force [N]\n" + "\n".join(rows) + "\n")
    return file


def test_rows_that_a_table_lacks_are_found_by_their_times(table: Path) -> None:
    log = read(table)
    (gap,) = log.gaps
    assert (gap.rows, gap.after_tick, log.lost) == (10, 39, 10)
    assert gap.t == pytest.approx(39 / 997, abs=1e-6)


@pytest.mark.parametrize("kind", ["csv", "npz", "parquet", "mat", "h5", "mcap"])
def test_a_table_can_be_exported_and_read_back(table: Path, kind: str) -> None:
    if needed := {"parquet": "pyarrow", "mat": "scipy", "h5": "h5py"}.get(kind):
        pytest.importorskip(needed)
    out = table.with_name(f"out.{kind}")
    assert runner.invoke(app, ["log", "export", str(table), str(out)]).exit_code == 0
    told = runner.invoke(app, ["log", "info", str(out), "--json"])
    assert told.exit_code == 0, told.output
    given, again = ebac.load(table), ebac.load(out)
    for name in ("t", "x", "force"):
        np.testing.assert_array_equal(again[name], given[name])
        assert again.columns[name].unit == given.columns[name].unit
    assert read(out).lost == 10


def test_ros_gets_the_rows_of_a_table(table: Path) -> None:
    out = table.with_name("bag.mcap")
    result = runner.invoke(app, ["log", "export", str(table), str(out), "--profile", "ros2"])
    assert result.exit_code == 0, result.output


def test_times_that_tell_no_step_leave_rows_their_places() -> None:
    for t in ([], [3.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.5, 2.0]):
        assert ticks_of(np.asarray(t, float)).tolist() == list(range(len(t)))


@given(
    steps=st.lists(st.integers(1, 3), min_size=3, max_size=60).filter(
        lambda steps: steps.count(1) > len(steps) / 2
    ),
    seed=st.integers(0, 99),
)
def test_ticks_follow_from_jittered_times(steps: list[int], seed: int) -> None:
    ticks = np.concatenate([[0], np.cumsum(steps)])
    late = np.random.default_rng(seed).uniform(0, 1e-4, len(ticks))
    assert ticks_of(1e-3 * ticks + late).tolist() == ticks.tolist()
