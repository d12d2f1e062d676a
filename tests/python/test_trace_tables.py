"""The page with the columns of a trace shows every column that a trace may have."""

import re
import sys
from pathlib import Path

import ebac

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS / "_ext"))

import trace_tables  # noqa: E402


def test_every_column_has_a_place_with_its_unit_and_meaning() -> None:
    page = (DOCS / "reference" / "trace.md").read_text(encoding="utf-8")
    shown = re.findall(r"```\{trace-columns\} (\w+)", page)
    assert shown == list(trace_tables.TABLES)
    rows = [row for name in ("every", "law", "true", "log") for row in trace_tables.TABLES[name]()]
    names = {row[0].strip("`") for row in rows}
    for law in ebac.LAWS:
        trace = ebac.simulate(ebac.Scenario(seconds=0.01), law)
        assert set(trace.columns) <= names
    assert all(unit and meaning for _, unit, meaning, *_ in rows)
    virtual = ebac.hardware.Configuration.load(trace_tables.CONFIGURATION).simulate(seconds=0.01)
    parts = {name.partition(".")[0] for name in virtual.columns if "." in name}
    assert parts <= {"est", "law", "true", "bus", "ft", "limit", "time"}
