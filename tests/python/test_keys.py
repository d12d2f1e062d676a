"""The keys of files: what is listed is what the readers take, with their ranges and defaults."""

import json
import re
import sys
from math import isfinite
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import ebac
from ebac import drives
from ebac._util.docstrings import parameters
from ebac.cli import app, completion
from ebac.drives.profile import read_profile
from ebac.drives.toml_positions import Source
from ebac.hardware import Configuration, ConfigurationError
from ebac.hardware.keys import CONFIGURATION, PROFILE, SCENARIO, FileKey, as_toml, file_keys
from ebac.hardware.keys.notes import FAULTS, NOTES, WARNINGS

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS / "figures"))

import key_tables  # noqa: E402

EVERY = file_keys()
SENSOR = "[sensor]\n"
#: What a table needs beside it.
BESIDE = {"observer": SENSOR}


def text_of(key: FileKey, value: str) -> str:
    """Return a configuration, or a profile, with this key alone."""
    typed = f'type = "{key.type}"\n' if key.type else ""
    return f"{BESIDE.get(key.table, '')}{key.heading}\n{typed}{key.name} = {value}\n"


def read(key: FileKey, text: str) -> Any:
    if PROFILE in key.files:
        return read_profile(Source(name="any.toml", text=text))
    return Configuration.from_toml(text)


def test_the_page_is_what_the_code_says() -> None:
    """`python docs/figures/tables.py keys-...` writes it anew."""
    page = (DOCS / "reference" / "configuration.md").read_text(encoding="utf-8")
    for name, made in key_tables.TABLES.items():
        block = f"<!-- table: {name} -->\n{made(None)}\n<!-- end -->"
        assert block in page, f"python docs/figures/tables.py {name}"


def test_every_key_has_a_meaning_and_every_number_a_unit() -> None:
    for key in EVERY:
        assert key.meaning, key
        number = isinstance(key.default, (int, float)) and not isinstance(key.default, bool)
        assert key.unit or not (number or key.low is not None) or key.choices, key


def test_a_key_is_listed_once() -> None:
    places = [(key.files, key.table, key.type, key.name) for key in EVERY]
    assert len(set(places)) == len(places)


def test_a_note_belongs_to_a_key() -> None:
    known = set()
    for key in EVERY:
        table = f"profile.{key.table}" if PROFILE in key.files else key.table
        known |= {f"{table}.{key.name}", f"{table}.{key.type}.{key.name}"}
    assert (NOTES.keys() | WARNINGS.keys()) <= known
    assert FAULTS.keys() <= {one.name for one in ebac.Limits.fields()}


#: Those in which any name may stand, or the parameters of a law.
OPEN = ("law", "objects", "pdo")
#: Parts of a table that are tables themselves.
PARTS = {"simulated.hand": {"path", "model"}, "device": {*ebac.Device().as_dict()}}
TABLES = sorted(
    {
        (key.files[0], key.table)
        for key in EVERY
        if key.table and key.table not in OPEN and "network file" not in key.files
    }
)


@pytest.mark.parametrize(("file", "table"), TABLES, ids=lambda word: word)
def test_the_keys_of_a_table_are_those_that_its_reader_takes(file: str, table: str) -> None:
    """A refusal lists them."""
    keys = [key for key in EVERY if key.files[0] == file and key.table == table]
    types = {key.type for key in keys}
    for kind in types - {""} or {""}:
        own = {key.name for key in keys if key.type in ("", kind)}
        line = FileKey(table=table, type=kind, name="none", meaning="", files=(file,))
        with pytest.raises(drives.ProfileError) as refused:
            read(line, text_of(line, "1"))
        listed = re.search(r"(?:there are|it has): ([\w, ]+)", str(refused.value))
        assert listed, str(refused.value)
        named = {*listed[1].split(", ")} - PARTS.get(table, set())
        assert named == own - ({"type"} if kind else set())


def test_the_keys_at_the_top_of_a_scenario_are_those_that_its_reader_takes() -> None:
    with pytest.raises(ValueError, match="none: no such name") as refused:
        ebac.Scenario.from_toml("none = 1\n")
    listed = {*str(refused.value).partition("there are: ")[2].split(", ")}
    tables = {"device", "hand", "environment", "timing"}
    keys = [key for key in EVERY if key.files == (SCENARIO,)]
    assert {key.name for key in keys} == listed - tables
    plain = ebac.Scenario()
    assert all(key.default == getattr(plain, key.name) for key in keys)
    for key in keys:
        for value in key.choices:
            assert ebac.Scenario.from_toml(f"{key.name} = {as_toml(value)}\n") == plain.replace(
                **{key.name: value}
            )


NUMBERS = [
    key
    for key in EVERY
    if key.low is not None
    and key.high is not None
    and key.table
    and key.name != "counts"
    and {CONFIGURATION, PROFILE} & {*key.files}
    and not key.table.startswith(("simulated.hand.", "pdo"))
]


@pytest.mark.parametrize("key", NUMBERS, ids=lambda key: f"{key.table}.{key.type}.{key.name}")
def test_a_number_beyond_its_range_is_refused(key: FileKey) -> None:
    whole = isinstance(key.default, int) or key.unit in ("samples", "counts")
    assert key.low is not None
    assert key.high is not None
    for bound, way in ((key.low, -1), (key.high, 1)):
        if not isfinite(bound):
            continue
        beyond = int(bound) + way if whole else bound + way * max(1e-9, abs(bound) / 100)
        if whole and abs(bound) > 2**53:
            beyond = int(bound * 1.1)
        with pytest.raises(drives.ProfileError, match=key.name):
            read(key, text_of(key, repr(beyond)))


@pytest.mark.parametrize(
    "table", sorted({key.table for key in EVERY if CONFIGURATION in key.files and key.table})
)
def test_the_defaults_of_a_table_are_those_that_are_read(table: str) -> None:
    keys = [key for key in EVERY if key.table == table and CONFIGURATION in key.files]
    if table in ("simulated.hand.path", "simulated.hand.model", "environment"):
        pytest.skip("several types")
    lines = [f"{BESIDE.get(table, '')}[{table}]\n"]
    for key in keys:
        default = key.default if key.configuration_default is None else key.configuration_default
        if default not in (None, "", []) and not key.type:
            exact = repr(default) if isinstance(default, float) else as_toml(default)
            lines.append(f"{key.name} = {exact}\n")
    given, plain = (
        Configuration.from_toml(text) for text in ("".join(lines), BESIDE.get(table, ""))
    )
    for part in ("device", "timing", "limits", "rendering", "realtime", "hand", "drives", "law", "sensor",
                 "interface", "channel", "setup", "silent", "answer_share", "seconds", "soft_start", "ramp_down",
                 "memory", "sync", "mode", "zero", "signs"):  # fmt: skip
        if (part, table) != ("sensor", "sensor"):
            assert getattr(given, part) == getattr(plain, part), part
    assert given.timed_bus() == plain.timed_bus()
    if table == "sensor":
        assert given.sensor == ebac.sensor.SensorConfig()
    if table == "observer":
        known = Configuration.from_toml(
            f'{SENSOR}[device]\npreset = "reference"\n[device.kinematics]\ntype = "Linear"\naxes = 2\n[observer]\n'
        )
        listed = {key.name: key.default for key in keys}
        assert ebac.Observer(**listed) == ebac.Observer.of(ebac.Device(), known.timing)
        assert known.observer is True


def test_the_ranges_of_a_force_sensor_are_those_of_the_core() -> None:
    for key in EVERY:
        if (
            key.table == "sensor"
            and key.low is not None
            and key.high is not None
            and isfinite(key.low)
        ):
            for value in (key.low, key.high):
                ebac.sensor.SensorConfig(**{key.name: value})


# --- the command ---


def ran(*words: str) -> Any:
    return CliRunner().invoke(app, ["keys", *words], env={"COLUMNS": "120"})


def rows(*words: str) -> list[dict[str, Any]]:
    answer = ran(*words, "--json")
    assert answer.exit_code == 0, answer.output
    found: list[dict[str, Any]] = json.loads(answer.stdout)["rows"]
    return found


def test_the_command_lists_every_key() -> None:
    assert [(row["table"], row["name"]) for row in rows()] == [(k.table, k.name) for k in EVERY]
    printed = ran().stdout
    assert all(key.name in printed for key in EVERY)


@pytest.mark.parametrize(
    ("word", "tables"),
    [
        ("device.motor", {"device.motor"}),
        ("[device.motor]", {"device.motor"}),
        ("thermal_time", {"limits"}),
        ("limits.thermal_time", {"limits"}),
        ("limits", {"limits"}),
        ("profile.limits", {"limits"}),
        ("network", {"bus", "node", "bus.other"}),
    ],
)
def test_a_table_a_key_or_a_kind_of_file(word: str, tables: set[str]) -> None:
    assert {row["table"] for row in rows(word)} == tables


def test_a_table_is_printed_with_unit_default_range_and_warning() -> None:
    printed = " ".join(ran("thermal_time").stdout.split())
    for part in (
        "[limits] (configuration)",
        "thermal_time 16 0.01 to 10000 s",
        "burns the winding.",
    ):
        assert part in printed
    (row,) = rows("thermal_time")
    assert (row["unit"], row["default"], row["low"], row["high"]) == ("s", 16.0, 0.01, 1e4)
    assert "burns the winding" in row["warning"]


def test_names_of_tables_are_completed() -> None:
    assert completion.keys("device.m") == ["device.motor", "device.mechanics"]
    assert completion.keys("net") == ["network"]


def test_a_name_that_is_none_is_refused_with_the_nearest() -> None:
    refused = ran("limts")
    assert refused.exit_code == 2
    assert "NAME limts: no such name, did you mean 'limits'" in " ".join(refused.stderr.split())


# --- docstrings ---


def test_parameters_of_a_docstring() -> None:
    class Some:
        """Of two sections.

        Parameters
        ----------
        one, other : float
            In two
            lines.

        Attributes
        ----------
        third : str
            Short.

        Raises
        ------
        ValueError : never
            Not this.
        """

    assert parameters(Some) == {"one": "In two lines.", "other": "In two lines.", "third": "Short."}


def test_an_error_of_the_device_names_the_command() -> None:
    with pytest.raises(
        ConfigurationError, match=r"`ebac keys device\.encoder` shows where it stands"
    ):
        Configuration.from_toml("[device.encoder]\ncounts_per_turn = 0\n")
