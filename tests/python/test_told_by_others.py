"""What a log or a configuration may tell that no program of ours writes. Most of it was found by fuzzing."""

import json
import struct
from pathlib import Path

import pytest

import ebac
from ebac.hardware import Configuration, ConfigurationError
from ebac.logs import About, read, repair
from ebac.logs.events import Event
from ebac.logs.layout import Layout
from ebac.logs.records import unpacked

DEEP = "[" * 100_000
LONG = "9" * 5000


@pytest.fixture
def trace() -> ebac.Trace:
    return ebac.simulate(ebac.Scenario(seconds=0.01), "eba")


def column(**changes: object) -> dict[str, object]:
    return {"name": "t", "unit": "s", "meaning": "", "kind": "float64", "size": 1, **changes}


@pytest.mark.parametrize(
    "columns",
    [
        DEEP,
        LONG,
        "null",
        "[]",
        "[1]",
        '["t"]',
        *(
            json.dumps([column(), column(name="tick", kind="int64"), column(**wrong)])
            for wrong in (
                {"name": True},
                {"name": ""},
                {"unit": None},
                {"kind": ["float64"]},
                {"kind": "float32"},
                {"size": 1.5},
                {"size": True},
                {"size": 65},
                {"more": 1},
            )
        ),
    ],
    ids=lambda text: text[-40:],
)
def test_columns_that_are_none_are_refused(columns: str) -> None:
    with pytest.raises(ValueError, match="its columns are not described as ebac does"):
        Layout.from_json(columns)


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ([column(), column(name="tick", kind="float64")], "tick a whole one"),
        ([column(), column(name="tick", kind="bool")], "tick a whole one"),
        ([column(kind="bool"), column(name="tick", kind="int64")], "must be numbers"),
        ([column(), column(name="tick", kind="int64"), column(name="#opcode")], "begins with #"),
        ([column()], "the columns t and tick are those"),
    ],
)
def test_columns_that_are_no_rows_are_refused(columns: list[object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Layout.from_json(json.dumps(columns))


def test_a_layout_that_somebody_else_told_costs_the_log_its_rows_and_says_so(
    trace: ebac.Trace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Layout, "to_json", lambda self: DEEP)
    trace.save(tmp_path / "log.mcap")
    with pytest.raises(ValueError, match=r"log\.mcap: no log of ebac, or cut .* not described"):
        read(tmp_path / "log.mcap")


@pytest.mark.parametrize("start", [LONG, "\u00b2", "-1", str(1 << 63), "soon"])
def test_a_start_that_cannot_be_is_none(
    trace: ebac.Trace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, start: str
) -> None:
    told = About(axes=1, law="eba").metadata
    monkeypatch.setattr(About, "metadata", {**told, "start_ns": start})
    trace.save(tmp_path / "log.mcap")
    monkeypatch.undo()
    log = read(tmp_path / "log.mcap")
    assert log.about.start_ns == 0
    assert len(log.trace) == len(trace)
    assert len(repair(log.path).trace) == len(trace)


EVENT = {"name": "fault", "message": "m", "tick": 1, "t": 0.5, "values": {}}


@pytest.mark.parametrize(
    "text",
    [
        DEEP,
        LONG,
        "7",
        *(
            json.dumps({**EVENT, **wrong})
            for wrong in (
                {"t": float("inf")},
                {"t": float("nan")},
                {"t": 1e300},
                {"tick": float("inf")},
                {"tick": 1 << 70},
                {"tick": None},
                {"values": 3},
            )
        ),
    ],
    ids=lambda text: text[-40:],
)
def test_an_event_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="event"):
        Event.from_json(text.encode())


@pytest.mark.slow
@pytest.mark.parametrize("how", ["zstd", "zstd, size not told", "lz4"])
@pytest.mark.parametrize("told", [100, 1 << 28])
def test_what_unpacks_to_more_than_it_says_is_not_unpacked(how: str, told: int) -> None:
    import lz4.frame
    import zstandard

    zeros = bytes(1 << 28)
    packed = {
        "zstd": lambda: zstandard.compress(zeros),
        "zstd, size not told": lambda: zstandard.ZstdCompressor(write_content_size=False).compress(
            zeros
        ),
        "lz4": lambda: lz4.frame.compress(zeros),
    }[how]()
    name = how.partition(",")[0].encode()
    head = struct.pack("<QQQII", 0, 0, told, 0, len(name)) + name
    with pytest.raises(ValueError, match=r"bytes|decompress"):
        unpacked(head + struct.pack("<Q", len(packed)) + packed)


@pytest.mark.parametrize("text", [f"a = {DEEP}", f"a = {LONG}", "a = 1\na = 2", "\x00"])
def test_text_that_is_no_toml_is_refused_by_name(text: str) -> None:
    with pytest.raises(ConfigurationError, match=r"mine\.toml: not a TOML document"):
        Configuration.from_toml(text, name="mine.toml")
    with pytest.raises(ValueError, match="not a TOML document"):
        ebac.Scenario.from_toml(text)


@pytest.mark.parametrize("name", [r"\u0000", "/", "."])
def test_drives_that_are_no_file_are_refused_by_line(name: str) -> None:
    with pytest.raises(
        ConfigurationError, match=r"mine\.toml, line 2: bus\.drives: .*cannot be read"
    ):
        Configuration.from_toml(f'[bus]\ndrives = "{name}"\n', name="mine.toml")


def test_a_file_that_is_no_text_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_bytes(b"[run]\nseconds = 1 # \xff\n")
    with pytest.raises(ConfigurationError, match=r"mine\.toml: is no text in UTF-8"):
        Configuration.load(path)
    with pytest.raises(ValueError, match=r"mine\.toml: "):
        ebac.Scenario.load(path)
