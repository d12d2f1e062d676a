"""Damaged logs and configurations: each is read or refused clearly; none crashes, hangs or eats the memory.

The issue asks for a million: EBAC_FUZZED_FILES=1000000 runs so many of each, in turn from case EBAC_FUZZED_FROM on.
"""

import functools
import json
import os
import random
import re
import resource
import struct
import tempfile
import time
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

import pytest
import zstandard
from mcap.exceptions import McapError

import ebac
from ebac.cli.log.info import document
from ebac.drives import network
from ebac.hardware import Configuration, ConfigurationError
from ebac.logs.about import About
from ebac.logs.events import Event
from ebac.logs.layout import Layout
from ebac.logs.log import Log
from ebac.logs.reader import read_bytes
from ebac.logs.writer import MAGIC, LogWriter

CASES = int(os.environ.get("EBAC_FUZZED_FILES", "400"))
FIRST = int(os.environ.get("EBAC_FUZZED_FROM", "0"))
EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"
#: In memory, where there is such a place: files are made and read by the thousand.
ROOM = next((path for path in ("/dev/shm",) if os.access(path, os.W_OK)), None)
#: No file of a few kB may take more memory or time than this [bytes, s].
MEMORY, TIME = 1 << 30, 20.0


@contextmanager
def frugal() -> Iterator[None]:
    """Let this process have so much more memory and no more."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    most = pages * resource.getpagesize() + MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (most, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def fuzz(one: Callable[[random.Random], bool], what: str) -> None:
    """Run all cases; `one` tells whether a file was read."""
    read, begun, slowest = 0, time.monotonic(), 0.0
    with frugal():
        for case in range(FIRST, FIRST + CASES):
            start = time.process_time()
            try:
                read += one(random.Random(f"{what} {case}"))
            except Exception as error:
                error.add_note(f"{what}, case {case}: EBAC_FUZZED_FROM={case} EBAC_FUZZED_FILES=1")
                raise
            slowest = max(slowest, time.process_time() - start)
    took = time.monotonic() - begun
    print(
        f"{CASES} {what}, {read} read, {CASES - read} refused; {CASES / took:.0f} a second, "
        f"the slowest {slowest:.3f} s of processor time"
    )
    assert slowest < TIME
    if CASES >= 200:
        assert 0.02 < read / CASES < 0.98, "the damage is all too small, or all too large"


def clear(error: Exception, begin: str) -> bool:
    """Require that a message says where and what; False, for the file was not read."""
    assert str(error).startswith(begin)
    assert len(str(error)) > len(begin) + 10
    return False


# --- logs ---


@dataclass(frozen=True)
class Part:
    """A record of a log: opcode and content."""

    opcode: int
    content: bytes

    @property
    def whole(self) -> bytes:
        return struct.pack("<BQ", self.opcode, len(self.content)) + self.content


@functools.cache
def logs() -> list[bytes]:
    """Small whole logs: of one axis, of two, with a scenario, without rows."""
    made = []
    with tempfile.TemporaryDirectory() as folder:
        for rows, axes, scenario in ((12, 1, False), (12, 2, False), (12, 1, True), (0, 1, False)):
            device = ebac.Device(kinematics=ebac.Linear(axes=axes))
            known = ebac.Scenario(device=device, seconds=0.02)
            trace = ebac.simulate(known, "eba").rows(0, rows)
            data = {name: trace[name] for name in trace}
            about = About(
                axes=axes, law="eba", scenario=known if scenario else None, made_by={"ebac": "1"}
            )
            path = Path(folder) / f"{len(made)}.mcap"
            with LogWriter(path, layout=Layout.of(data, trace.columns), about=about) as log:
                for first in range(0, rows, 4):
                    event = Event(kind="parameter", message="m", tick=first, t=0.0, values={"a": 1})
                    log.write({n: v[first : first + 4] for n, v in data.items()}, [event])
                log.close(rows=rows)
            made.append(path.read_bytes())
    return made


@functools.cache
def parts(i: int) -> list[Part]:
    """The records of a log."""
    data, at, found = logs()[i], len(MAGIC), []
    while at < len(data) - len(MAGIC):
        opcode, length = struct.unpack_from("<BQ", data, at)
        found.append(Part(opcode, data[at + 9 : at + 9 + length]))
        at += 9 + length
    return found


def flipped(data: bytes, chance: random.Random, most: int = 8) -> bytes:
    """Flip some bits."""
    new = bytearray(data)
    for _ in range(chance.randint(1, most) if data else 0):
        new[chance.randrange(len(new))] ^= 1 << chance.randrange(8)
    return bytes(new)


def wrong_number(data: bytes, chance: random.Random) -> bytes:
    """Put another number where one may stand: a length, a size, a time."""
    size = chance.choice([2, 4, 8])
    if len(data) < size:
        return data
    at = chance.randrange(len(data) - size + 1)
    most = (1 << 8 * size) - 1
    value = chance.choice([0, 1, 255, most, most >> 1, most - 7, chance.randint(0, most)])
    return data[:at] + value.to_bytes(size, "little") + data[at + size :]


def cut(data: bytes, chance: random.Random) -> bytes:
    return data[: chance.randrange(len(data) + 1)]


def rubbish(data: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(data) + 1)
    return data[:at] + chance.randbytes(chance.randint(1, 40)) + data[at:]


def other_text(data: bytes, chance: random.Random) -> bytes:
    """Replace a number or a word in what is text: names, JSON, TOML."""
    begin = chance.randrange(max(1, len(data)))
    word = re.compile(rb"-?\d+|[a-z_]{2,}|[\[\]{}:,=\"]").search(data, begin)
    if word is None:
        return data
    return data[: word.start()] + chance.choice(WORDS) + data[word.end() :]


WORDS = [
    *(
        b"-1",
        b"0",
        b"1e999",
        b"NaN",
        b"99999999999999999999",
        b"true",
        b"null",
        b"[]",
        b"{}",
        b'""',
    ),
    *(b"[" * 3000, b"\xff\xfe", b"\x00", b"x" * 500, b"float64", b"bool", b"int32", b"64", b"tick"),
    *(b'"t"', b"9" * 5000, b"\n", b"'", b"[", b"]", b"]]", b"law", b"axes", b"\xc2\xb2"),
]
#: Sizes of what unpacks to much more than it is [bytes].
BOMBS = (1 << 24, 1 << 28)
DAMAGES = [flipped, wrong_number, cut, rubbish, other_text]


def within_chunk(content: bytes, chance: random.Random) -> bytes:
    """Damage what a chunk holds, and pack it so that its sizes and its checksum are right again."""
    first, last, _, _, letters = struct.unpack_from("<QQQII", content)
    packed = content[32 + letters + 8 :]
    inside = chance.choice(DAMAGES)(zstandard.decompress(packed), chance)
    how = chance.choice(["zstd", "zstd", "", "lz4"])
    if how == "zstd":
        packed = zstandard.compress(inside, 1)
    elif how == "lz4":
        import lz4.frame

        packed = lz4.frame.compress(inside)
    else:
        packed = inside
    size = chance.choice([len(inside), len(inside), 0, 1 << 30, 1 << 62])
    crc = chance.choice([0, zlib.crc32(inside)])
    head = struct.pack("<QQQII", first, last, size, crc, len(how)) + how.encode()
    return head + struct.pack("<Q", len(packed)) + packed


#: What may stand in JSON, or as text, where something else is expected.
ODD = [
    *(
        None,
        True,
        -1,
        0,
        3,
        1.5,
        65,
        1 << 70,
        "",
        "t",
        "tick",
        "x" * 300,
        "#opcode",
        "bool",
        "\x00",
    ),
    *([], {}, ["float64"], {"a": []}, "a.b", "a_b", "[" * 50_000, "9" * 5000, "\u00b2", "float64"),
]


def other_value(value: object, chance: random.Random) -> object:
    """Replace something within what JSON told."""
    if isinstance(value, list) and value and chance.random() < 0.95:
        i = chance.randrange(len(value))
        if chance.random() < 0.1:
            return value[:i] + value[i + 1 :]
        if chance.random() < 0.1:
            return [*value, value[i]]
        return [*value[:i], other_value(value[i], chance), *value[i + 1 :]]
    if isinstance(value, dict) and value and chance.random() < 0.95:
        name = chance.choice(list(value))
        if chance.random() < 0.1:
            return {key: one for key, one in value.items() if key != name}
        return {**value, name: other_value(value[name], chance)}
    return chance.choice(ODD)


def retold(record: Part, chance: random.Random) -> Part:
    """A channel or metadata, whole, that tells something odd."""
    from mcap.data_stream import ReadDataStream, RecordBuilder
    from mcap.records import Channel, Metadata

    kinds = {0x04: Channel, 0x0C: Metadata}
    if record.opcode not in kinds:
        return record
    told = kinds[record.opcode].read(ReadDataStream(BytesIO(record.content)))
    name = chance.choice(list(told.metadata) or ["columns"])
    if name == "columns":
        columns = other_value(json.loads(told.metadata.get("columns", "[]")), chance)
        told.metadata[name] = columns if isinstance(columns, str) else json.dumps(columns)
    else:
        told.metadata[name] = str(chance.choice(ODD))
    builder = RecordBuilder()
    told.write(builder)
    return Part(record.opcode, builder.end()[9:])


def odd_event(chance: random.Random) -> Part:
    """A chunk with an event that tells something odd."""
    event = {"name": "fault", "message": "m", "tick": 1, "t": 0.5, "values": {"fault": 3}}
    text = json.dumps(other_value(event, chance)).encode()
    message = struct.pack("<BQHIQQ", 0x05, 22 + len(text), 2, 0, 0, 0) + text
    head = struct.pack("<QQQII", 0, 0, len(message), zlib.crc32(message), 0)
    return Part(0x06, head + struct.pack("<Q", len(message)) + message)


def bomb(chance: random.Random) -> Part:
    """A chunk of a few bytes that says truly, or does not say, that it is large."""
    size = chance.choice(BOMBS)
    how, packed = chance.choice(_bombs(size))
    told = chance.choice([size, 100, (1 << 31) - 1, 0])
    head = struct.pack("<QQQII", 0, 0, told, 0, len(how)) + how.encode()
    return Part(0x06, head + struct.pack("<Q", len(packed)) + packed)


@functools.cache
def _bombs(size: int) -> list[tuple[str, bytes]]:
    import lz4.frame

    zeros = bytes(size)
    untold = zstandard.ZstdCompressor(write_content_size=False).compress(zeros)
    return [
        ("zstd", zstandard.compress(zeros)),
        ("zstd", untold),
        ("lz4", lz4.frame.compress(zeros)),
        ("lz4", lz4.frame.compress(zeros, store_size=False)),
    ]


def damaged_log(chance: random.Random) -> bytes:
    """A log with one or a few things wrong."""
    which = chance.choices(range(4), [10, 6, 1, 2])[0]
    if chance.random() < 0.2:
        data = logs()[which]
        for _ in range(chance.randint(1, 3)):
            data = chance.choice(DAMAGES)(data, chance)
        return data
    records = list(parts(which))
    for _ in range(chance.randint(1, 3)):
        i = chance.randrange(len(records)) if records else 0
        what = chance.choices(
            ["damage", "twice", "swap", "drop", "inside", "bomb", "opcode", "retold", "event"],
            [5, 1, 1, 1, 5, 0.02, 1, 5, 1],
        )[0]
        if not records or what == "bomb":
            records.insert(i, bomb(chance))
        elif what == "damage":
            one = records[i]
            records[i] = Part(one.opcode, chance.choice(DAMAGES)(one.content, chance))
        elif what == "twice":
            records.insert(chance.randrange(len(records) + 1), records[i])
        elif what == "swap":
            j = chance.randrange(len(records))
            records[i], records[j] = records[j], records[i]
        elif what == "drop":
            del records[i]
        elif what == "retold":
            told = [j for j, one in enumerate(records) if one.opcode in (0x04, 0x0C)]
            # Not where it is damaged already.
            with suppress(McapError, ValueError, struct.error, RecursionError):
                i = chance.choice(told or [i])
                records[i] = retold(records[i], chance)
        elif what == "event":
            records.insert(i, odd_event(chance))
        elif what == "opcode":
            records[i] = Part(chance.randrange(256), records[i].content)
        elif records[i].opcode == 0x06 and len(records[i].content) > 60:
            with suppress(zstandard.ZstdError, struct.error):  # damaged already
                records[i] = Part(0x06, within_chunk(records[i].content, chance))
    data = MAGIC + b"".join(one.whole for one in records) + MAGIC
    return data if chance.random() < 0.9 else cut(data, chance)


def look_at(log: Log) -> None:
    """What everybody asks of a log."""
    rows = len(log.trace)
    assert all(len(log.trace[name]) == rows for name in log.trace)
    assert log.lost >= 0
    assert len(log.faults) <= rows
    json.dumps([event.values for event in log.events])


def read_a_log(chance: random.Random) -> bool:
    try:
        log = read_bytes(damaged_log(chance), "fuzzed.mcap")
    except ValueError as error:
        return clear(error, "fuzzed.mcap: ")
    look_at(log)
    if chance.random() < 0.02:
        mended(log)
        assert json.loads(document(log))["command"] == "log info"
    return True


def mended(log: Log) -> None:
    """What was read of a log can be written, and is then a whole one."""
    with tempfile.TemporaryDirectory(dir=ROOM) as folder:
        path = Path(folder) / "fuzzed.mcap"
        log.trace.save(path)
        new = read_bytes(path.read_bytes(), "written.mcap")
        assert new.condition.complete
        assert len(new.trace) == len(log.trace)


@pytest.mark.slow
def test_damaged_logs_are_read_or_refused() -> None:
    for size in BOMBS:
        _bombs(size)
    for data in logs():
        look_at(read_bytes(data, "whole.mcap"))
    fuzz(read_a_log, "logs")


# --- configurations ---

#: A value that TOML knows and hardly any key does.
VALUES = [
    *("0", "-1", "1", "3", "1e9", "-1e-9", "nan", "inf", "-inf", "1e400", "true", '""', '"x"'),
    *("[]", "[1]", "[[]]", "[nan]", "{}", "{type = 'Wall'}", "{a = 1}", "1979-05-27", "07:32:00"),
    *("99999999999999999999", "9" * 5000, "0x7fffffff", "-9223372036854775809", "'''a\nb'''"),
    *('"\\u0000"', '"ebac"', '"joystick"', '"off"', '"../../etc/passwd"', '"."', '"/"', '"Free"'),
    *('"Step"', "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]", "[0, 0, 0, 0, 0, 0]", '"reference"', "[{}]"),
    *('[{type = "Step", target = 0.1}]', '{type = "Sine"}', "{type = 1}", '"192.168.1.1"', "8"),
    *("{motor = 1}", "0.5", "1e-3", "2", '"Wall"', '"eba"', '"net-ft"', '"\U0001f600"'),
]
KEYS = [
    *("type", "name", "preset", "stiffness", "position", "dt", "delay", "mass", "motor", "axes"),
    *(
        "kinematics",
        "seconds",
        "mode",
        "priority",
        "cpu",
        "host",
        "port",
        "path",
        "rotation",
        "bias",
    ),
    *("hand", "memory", "sync", "drives", "channel", "interface", "silent", "overruns", "damping"),
    *(
        "encoder",
        "cable",
        "friction",
        "sensor",
        "release_at",
        "soft_start",
        "kp",
        "beta",
        "xyz",
        '""',
    ),
]
TABLES = [
    *("about", "bus", "device", "device.motor", "device.kinematics", "device.encoder", "timing"),
    *("environment", "law", "limits", "run", "realtime", "recording", "sensor", "simulated"),
    *("simulated.hand", "simulated.hand.path", "xyz", "device.cable", "device.sensor", "zero"),
]


def generated(chance: random.Random) -> str:
    """A document of tables, keys and values that exist, seldom together."""
    lines = []
    for table in chance.sample(TABLES, chance.randint(1, 3)):
        lines.append(f"[[{table}]]" if chance.random() < 0.1 else f"[{table}]")
        for key in chance.sample(KEYS, chance.randint(0, 3)):
            lines.append(f"{key} = {chance.choice(VALUES)}")
    return "\n".join(lines) + "\n"


@functools.cache
def tables_of_the_example() -> list[list[str]]:
    """The tables of the example without its comments, each with its lines."""
    tables: list[list[str]] = []
    for line in EXAMPLE.read_text(encoding="utf-8").splitlines():
        text = line.split("#")[0].rstrip()
        if text.startswith("["):
            tables.append([])
        if text and tables:
            tables[-1].append(text)
    return tables


def damaged_example(chance: random.Random) -> str:
    """A few tables of the example, with a few lines or letters wrong."""
    tables = chance.sample(tables_of_the_example(), chance.randint(1, 4))
    lines = [line for table in tables for line in table]
    for _ in range(chance.randint(1, 2)):
        i = chance.randrange(len(lines)) if lines else 0
        what = chance.randrange(6)
        if not lines or what == 0:
            lines.insert(i, f"{chance.choice(KEYS)} = {chance.choice(VALUES)}")
        elif what == 1:
            lines[i] = f"{lines[i].partition('=')[0]}= {chance.choice(VALUES)}"
        elif what == 2:
            del lines[i]
        elif what == 3:
            lines.insert(chance.randrange(len(lines) + 1), lines[i])
        elif what == 4 and lines[i]:
            at = chance.randrange(len(lines[i]))
            lines[i] = lines[i][:at] + chr(chance.choice([0, 34, 61, 91, 93, 955])) + lines[i][at:]
        else:
            j = chance.randrange(len(lines))
            lines[i], lines[j] = lines[j], lines[i]
    return "\n".join(lines)


def read_a_configuration(chance: random.Random) -> bool:
    text = (generated if chance.random() < 0.5 else damaged_example)(chance)
    try:
        known = Configuration.from_toml(text, name="fuzzed.toml")
    except ConfigurationError as error:
        return clear(error, "fuzzed.toml")
    try:
        known.scenario()
        known.design()
    except ValueError as error:
        return clear(error, "")
    return True


def test_damaged_configurations_are_read_or_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    load = network.load
    known = load("joystick")  # the drives that come with ebac, once and not in every case
    monkeypatch.setattr(network, "load", lambda path: known if path == "joystick" else load(path))
    fuzz(read_a_configuration, "configurations")


@pytest.mark.parametrize(
    ("name", "read"),
    [
        ("run.csv", ebac.logs.load),
        ("log.csv", ebac.identify.load),
        ("path.csv", ebac.tracking.read_path),
        ("hands.csv", ebac.Operators.from_csv),
        ("scenario.toml", ebac.Scenario.load),
        ("device.toml", ebac.hardware.Configuration.load),
        ("drive.toml", ebac.drives.load),
    ],
)
@pytest.mark.parametrize(
    ("data", "byte"), [(b"t [s],x [m]\n0,1\n\xff,2\n", "0xff"), (b"a\n\nb\0", "0x00")]
)
def test_what_is_no_text_is_refused_by_file_line_and_byte(
    name: str, read: Callable[[Path], object], data: bytes, byte: str, tmp_path: Path
) -> None:
    if (name, byte) == ("run.csv", "0x00"):
        pytest.skip("its headings are refused first")
    file = tmp_path / name
    file.write_bytes(data)
    with pytest.raises(Exception, match=rf"is no text in UTF-8 \(line 3, byte {byte}\)") as refused:
        read(file)
    assert name in str(refused.value)
    (tmp_path / "folder.npz").mkdir()
    with pytest.raises(IsADirectoryError, match="is a folder"):
        ebac.load(tmp_path / "folder.npz")
