"""Logs as bags of ROS 2, read back by mcap-ros2-support and by rosbags."""

import json
import re
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.logs import About, Event, LogWriter, load, read, to_ros2
from ebac.logs.layout import Layout
from ebac.trace.columns import ColumnInfo

runner = CliRunner()
START = 1_760_000_000_123_456_789  # ns since 1970
EVENTS = [
    Event(kind="note", message="Größe, 力\0", tick=10, t=0.01, values={"force_N": -1.5}),
    Event(kind="lost", message="7 rows", tick=50, t=0.05),
    Event(kind="fault", message="fault 9", tick=100, t=0.1, values={"fault": 9}),
]
LEVELS = {"note": 20, "lost": 30, "fault": 50}
STANDARD = {
    "/ebac/joint_states": "sensor_msgs/msg/JointState",
    "/ebac/wrench": "geometry_msgs/msg/WrenchStamped",
    "/ebac/events": "rcl_interfaces/msg/Log",
}


def logged(path: Path, trace: ebac.Trace, rows: int = 50) -> Path:
    data = {name: trace[name] for name in trace}
    about = About(axes=trace.axes, law=trace.law, scenario=trace.scenario, start_ns=START)
    with LogWriter(path, layout=Layout.of(data, trace.columns), about=about) as log:
        for first in range(0, len(trace), rows):
            log.write({name: values[first : first + rows] for name, values in data.items()})
        log.write({name: values[:0] for name, values in data.items()}, EVENTS)
        log.close(rows=len(trace), lost=0)
    return path


@pytest.fixture(params=[1, 2, 3], ids=["one axis", "two axes", "three axes"])
def log(request: pytest.FixtureRequest, run: Any, tmp_path: Path) -> Path:
    device = ebac.Device(kinematics=ebac.Linear(axes=request.param))
    world = ebac.Corner() if request.param > 1 else ebac.Wall()
    return logged(tmp_path / "run.mcap", run("ebac", device=device, environment=world, seconds=0.3))


@pytest.fixture
def short(run: Any, tmp_path: Path) -> Path:
    return logged(tmp_path / "run.mcap", run("ebac", seconds=0.1))


def by_mcap_ros2(path: Path) -> dict[str, list[tuple[int, Any]]]:
    """Messages of each topic with their log time."""
    reader = pytest.importorskip("mcap_ros2.reader")
    found: dict[str, list[tuple[int, Any]]] = {}
    for message in reader.read_ros2_messages(str(path)):
        assert message.log_time_ns == message.publish_time_ns
        found.setdefault(message.channel.topic, []).append((message.log_time_ns, message.ros_msg))
    return found


def by_rosbags(path: Path) -> dict[str, list[tuple[int, Any]]]:
    """The same; what rosbags writes of each message is that message to the byte."""
    highlevel = pytest.importorskip("rosbags.highlevel")
    stores = pytest.importorskip("rosbags.typesys")
    standard = stores.get_typestore(stores.Stores.ROS2_JAZZY)
    found: dict[str, list[tuple[int, Any]]] = {}
    with highlevel.AnyReader([path]) as reader:
        for connection, time, raw in reader.messages():
            known = connection.topic in STANDARD
            types = standard if known else reader.typestore
            message = types.deserialize_cdr(raw, connection.msgtype)
            assert bytes(types.serialize_cdr(message, connection.msgtype)) == bytes(raw)
            if known:
                assert connection.msgtype == STANDARD[connection.topic]
                hashes = [t.hash_rihs01(connection.msgtype) for t in (standard, reader.typestore)]
                assert hashes[0] == hashes[1]
            found.setdefault(connection.topic, []).append((time, message))
    return found


@pytest.fixture(params=[by_mcap_ros2, by_rosbags], ids=["mcap-ros2-support", "rosbags"])
def messages(request: pytest.FixtureRequest) -> Any:
    return request.param


def same(values: Any, column: Any) -> bool:
    """Whether values are a column's to the bit, NaN included."""
    given = np.asarray(values).reshape(column.shape).astype(column.dtype)
    return given.tobytes() == np.ascontiguousarray(column).tobytes()


def test_every_value_comes_back_to_the_bit(log: Path, tmp_path: Path, messages: Any) -> None:
    bag = to_ros2(log, tmp_path / "bag.mcap")
    trace, found = load(log), messages(bag.path)
    assert bag.messages == {topic: len(those) for topic, those in found.items()}
    assert bag.messages == {
        "/ebac/row": len(trace),
        "/ebac/joint_states": len(trace),
        "/ebac/wrench": len(trace),
        "/ebac/events": 3,
    }
    times = START + np.rint(1e9 * trace["t"]).astype(np.int64)
    for topic in ("/ebac/row", "/ebac/joint_states", "/ebac/wrench"):
        assert [time for time, _ in found[topic]] == times.tolist()
    rows = [row for _, row in found["/ebac/row"]]
    for name in trace:
        assert same([getattr(row, name.replace(".", "_")) for row in rows], trace[name]), name
    joints = [state for _, state in found["/ebac/joint_states"]]
    for field, name in (("position", "q"), ("velocity", "dq"), ("effort", "tau")):
        assert same([getattr(state, field) for state in joints], trace[name])
    assert joints[5].name == [f"joint_{i}" for i in range(trace.axes)]
    wrenches = [stamped.wrench for _, stamped in found["/ebac/wrench"]]
    force = np.array([[w.force.x, w.force.y, w.force.z] for w in wrenches])
    assert same(force[:, : trace.axes], trace["f_meas"])
    assert not force[:, trace.axes :].any()
    assert not any(w.torque.x or w.torque.y or w.torque.z for w in wrenches)
    for topic, frame in (("/ebac/joint_states", ""), ("/ebac/wrench", "handle")):
        for time, message in found[topic]:
            stamp = message.header.stamp
            assert 1_000_000_000 * stamp.sec + stamp.nanosec == time
            assert message.header.frame_id == frame


def test_events_are_log_messages(short: Path, tmp_path: Path, messages: Any) -> None:
    found = messages(to_ros2(short, tmp_path / "bag.mcap").path)["/ebac/events"]
    for event, (time, message) in zip(EVENTS, found, strict=True):
        assert time == event.time_ns(START)
        assert 1_000_000_000 * message.stamp.sec + message.stamp.nanosec == time
        assert message.level == LEVELS[event.kind]
        assert message.name == f"ebac.{event.kind}"
        words, _, values = message.msg.partition(" {")
        assert words == event.message.replace("\0", " ")
        assert json.loads("{" + values) == {"tick": event.tick, **event.values}


def test_units_stand_in_the_definition(short: Path, tmp_path: Path) -> None:
    trace = load(short)
    with to_ros2(short, tmp_path / "bag.mcap").path.open("rb") as file:
        reader = make_reader(file)
        header, summary = reader.get_header(), reader.get_summary()
        attached = {one.name: one.data.decode() for one in reader.iter_attachments()}
        metadata = {record.name: record.metadata for record in reader.iter_metadata()}
    assert header.profile == "ros2"
    assert summary is not None
    assert {channel.message_encoding for channel in summary.channels.values()} == {"cdr"}
    assert {schema.encoding for schema in summary.schemas.values()} == {"ros2msg"}
    text = next(s.data.decode() for s in summary.schemas.values() if s.name.endswith("/Row"))
    units = dict(re.findall(r"^\S+ (\S+)  # \[(.*?)\]", text, re.MULTILINE))
    assert units == {name.replace(".", "_"): trace.columns[name].unit for name in trace}
    assert trace.scenario is not None
    assert attached["scenario.toml"] == trace.scenario.to_toml()
    assert metadata["ebac"]["law"] == trace.law


def test_a_trace_gives_the_same_messages(run: Any, tmp_path: Path, messages: Any) -> None:
    trace = run("ebac", seconds=0.1)
    trace.save(tmp_path / "bag.mcap", profile="ros2")
    trace.save(tmp_path / "run.npz")
    again = to_ros2(tmp_path / "run.npz", tmp_path / "again.mcap")
    assert (tmp_path / "bag.mcap").read_bytes() == again.path.read_bytes()
    assert same([row.x for _, row in messages(again.path)["/ebac/row"]], trace["x"])


def test_a_trace_without_joint_rates(run: Any, tmp_path: Path, messages: Any) -> None:
    whole = run("ebac", seconds=0.02)
    left = [name for name in whole if name not in ("dq", "f_meas")]
    trace = ebac.Trace(
        data={name: whole[name] for name in left},
        columns={name: whole.columns[name] for name in left},
        axes=1,
    )
    trace.save(tmp_path / "bag.mcap", profile="ros2")
    found = messages(tmp_path / "bag.mcap")
    assert set(found) == {"/ebac/row", "/ebac/joint_states"}
    states = [state for _, state in found["/ebac/joint_states"]]
    assert not any(len(state.velocity) for state in states)
    assert same([state.effort for state in states], trace["tau"])


def test_a_part_by_the_command(short: Path, tmp_path: Path, messages: Any) -> None:
    words = ["--profile", "ros2", "--from", "0.02", "--to", "0.06", "--json"]
    done = runner.invoke(app, ["log", "export", str(short), str(tmp_path / "bag.mcap"), *words])
    assert done.exit_code == 0, done.output
    (row,) = json.loads(done.stdout)["rows"]
    part = load(short, start=0.02, stop=0.06)
    found = messages(tmp_path / "bag.mcap")
    assert row["messages"] == {topic: len(those) for topic, those in found.items()}
    assert row["rows"] == len(part) == 40
    assert same([one.t for _, one in found["/ebac/row"]], part["t"])
    assert len(found["/ebac/events"]) == 1
    done = runner.invoke(app, ["log", "export", str(short), str(tmp_path / "b.mcap"), *words[:2]])
    assert done.exit_code == 0
    assert "/ebac/wrench: 101 messages" in done.output


def test_damage_is_told_and_left_out(short: Path, tmp_path: Path, messages: Any) -> None:
    data = bytearray(short.read_bytes())
    data[len(data) // 3] ^= 0xFF
    short.write_bytes(data)
    bag = tmp_path / "bag.mcap"
    done = runner.invoke(app, ["log", "export", str(short), str(bag), "--profile", "ros2"])
    assert done.exit_code == 3, done.output
    assert "1 damaged part left out" in " ".join(done.output.split())
    assert len(messages(bag)["/ebac/row"]) == len(read(short).trace) < 101


def test_a_log_without_rows(short: Path, tmp_path: Path) -> None:
    load(short).between(0, 0).save(tmp_path / "none.mcap")
    bag = to_ros2(tmp_path / "none.mcap", tmp_path / "bag.mcap")
    assert set(bag.messages.values()) == {0}
    with bag.path.open("rb") as file:
        assert list(make_reader(file).iter_messages()) == []


# --- what is refused ---


@pytest.mark.parametrize("command", ["info", "repair", "plot", "export", "export --profile ros2"])
def test_a_bag_is_no_log(command: str, short: Path, tmp_path: Path) -> None:
    bag = to_ros2(short, tmp_path / "bag.mcap").path
    name, *words = command.split()
    out = [str(tmp_path / "out.mcap")] if name == "export" else []
    before = set(tmp_path.iterdir())
    done = runner.invoke(app, ["log", name, str(bag), *out, *words])
    assert done.exit_code == 2
    assert "a bag of ROS 2, no log of ebac" in " ".join(done.output.split())
    assert set(tmp_path.iterdir()) == before
    with pytest.raises(ValueError, match=r"bag of ROS 2.*rosbags"):
        load(bag)


def test_what_cannot_be_written(short: Path, run: Any, tmp_path: Path) -> None:
    before = short.read_bytes()
    with pytest.raises(ValueError, match="is the log itself"):
        to_ros2(short, short)
    assert short.read_bytes() == before
    with pytest.raises(ValueError, match=r"must end in \.mcap"):
        to_ros2(short, tmp_path / "bag.db3")
    with pytest.raises(FileNotFoundError):
        to_ros2(tmp_path / "none.mcap", tmp_path / "bag.mcap")
    with pytest.raises(FileNotFoundError, match=re.escape("none/bag.mcap")):
        to_ros2(short, tmp_path / "none" / "bag.mcap")
    trace = load(short)
    with pytest.raises(ValueError, match=r"profile 'ros1': must be ebac or ros2"):
        trace.save(tmp_path / "bag.mcap", profile="ros1")
    with pytest.raises(ValueError, match=r"run\.csv: the profile ros2 must end in \.mcap"):
        trace.save(tmp_path / "run.csv", profile="ros2")
    done = runner.invoke(app, ["log", "export", str(short), str(tmp_path / "a.npz"), "--profile", "ros2"])  # fmt: skip
    assert done.exit_code == 2
    assert "must end in .mcap" in done.output
    assert list(tmp_path.iterdir()) == [short]


def test_a_column_no_message_can_have(short: Path, tmp_path: Path) -> None:
    trace = load(short)
    columns = {**trace.columns, "law.β": ColumnInfo(name="law.β", unit="1", meaning="")}
    data = {**{name: trace[name] for name in trace}, "law.β": trace["x"]}
    (tmp_path / "bag.mcap").write_bytes(b"old")
    with pytest.raises(ValueError, match=r"column 'law\.β': a field of a ROS 2 message"):
        ebac.Trace(data=data, columns=columns, axes=1).save(tmp_path / "bag.mcap", profile="ros2")
    assert (tmp_path / "bag.mcap").read_bytes() == b"old"
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.slow
@pytest.mark.weekly
def test_a_long_log_is_never_in_memory(tmp_path: Path) -> None:
    rows = 40_000
    names = [f"a{i}" for i in range(98)]
    noise = np.random.default_rng(1).normal(size=(len(names), rows))
    data = {"t": 1e-3 * np.arange(rows), "tick": np.arange(rows), **dict(zip(names, noise, strict=True))}  # fmt: skip
    columns = {name: ColumnInfo(name=name, unit="1", meaning="") for name in data}
    path = logged(tmp_path / "run.mcap", ebac.Trace(data=data, columns=columns, axes=1), rows=200)
    del data, noise
    size = path.stat().st_size
    tracemalloc.start()
    try:
        assert to_ros2(path, tmp_path / "bag.mcap").messages["/ebac/row"] == rows
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert size > 29e6
    assert most < 0.5 * size
