"""The tables of the pages are what the commands print, and each has a place."""

import json
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS / "figures"))

import printed  # noqa: E402
import rival_tables  # noqa: E402
import tables  # noqa: E402

import ebac  # noqa: E402


def test_every_table_has_one_place_and_every_place_a_table() -> None:
    places = [name for page in tables.PAGES for name in printed.names(page)]
    assert sorted(places) == sorted(tables.TABLES)


def test_hands_force_swing_and_energy_of_the_rivals_stand_in_one_table(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A row per law and form, the hands of the six conditions together, beside what the searches drew."""

    class Kept:
        threads = 1

        def rows(self, command: str) -> list[printed.Row]:
            if command.startswith("worst"):
                return [{"energy_drawn_J": 1e-3}, {"energy_drawn_J": 5e-3}]
            return [{"least_energy_J": energy} for energy in (0.0, -2e-3, 0.0, -3e-3)]

    few = ebac.Operators.grid()[::20]
    monkeypatch.setattr(ebac.Operators, "grid", lambda: few)
    laws = dict(list(rival_tables.RANGES.items())[:2])
    monkeypatch.setattr(rival_tables, "RANGES", laws)
    for name, columns in (("tuned", 9), ("tuned-cells", 8)):
        lines = tables.TABLES[name](Kept()).splitlines()  # type: ignore[arg-type]
        cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
        assert {len(row) for row in cells} == {columns}
        assert [tuple(row[:2]) for row in cells[2:]] == [
            (f"`{law}`", word) for law in (*laws, "ebac") for word in ("no", "yes")
        ]
        if name == "tuned":
            assert all(row[-3:] == ["-2", "-3", "-5"] for row in cells[2:])  # mJ
            assert cells[0][2:5] == ["good of 360", "settled, median [s]", "force swing [N]"]


@pytest.mark.slow
@pytest.mark.weekly
def test_what_stands_in_the_pages_of_60_hands_is_what_the_study_gives(tmp_path: Path) -> None:
    source = printed.Printed(folder=tmp_path / "kept")
    source.folder.mkdir()
    for page, name in (("evidence.md", "grid"), ("story.md", "hands")):
        copy = tmp_path / page
        copy.write_text((DOCS / "explanation" / page).read_text(encoding="utf-8"), encoding="utf-8")
        assert not printed.put(copy, name, tables.TABLES[name](source)), f"{name} has changed"


def test_only_what_lies_between_the_marks_is_written(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    text = (
        "a\n<!-- table: one -->\nold\n<!-- end -->\nb\n<!-- table: two -->\nold\n<!-- end -->\nc\n"
    )
    page.write_text(text)
    assert printed.put(page, "two", "new\n")
    assert page.read_text() == text.replace("two -->\nold", "two -->\nnew")
    assert not printed.put(page, "two", "new")


def test_what_is_kept_is_not_run_again(tmp_path: Path) -> None:
    (tmp_path / "study-law-all.json").write_text(json.dumps({"rows": [{"law": "kept"}]}))
    assert printed.Printed(folder=tmp_path).rows("study --law all") == [{"law": "kept"}]


@given(st.floats(-1e4, 1e4).filter(lambda e: abs(e) > 1e-6))
def test_an_energy_reads_back(energy: float) -> None:
    word = printed.joules(energy, " mJ")
    number, unit = word.split()
    assert float(number) * {"mJ": 1e-3, "J": 1.0}[unit] == pytest.approx(energy, rel=0.06)


def test_energies_as_they_are_written() -> None:
    told = {
        0.0: "0",
        -9.29e-3: "-9.29",
        -0.9994: "-999",
        -0.9996: "-1.0\N{NO-BREAK SPACE}J",
        99.96: "100\N{NO-BREAK SPACE}J",
    }
    assert {e: printed.joules(e) for e in told} == told
    assert printed.joules(-0.0) == "0"
    assert printed.joules(None) == "-"


def test_the_parameters_on_the_page_are_those_of_the_package() -> None:
    """The table of them could not be written: its file had moved."""
    page = (DOCS / "explanation" / "rivals.md").read_text(encoding="utf-8")
    wanted = rival_tables.tuned_values(None).strip()  # type: ignore[arg-type]
    assert f"<!-- table: tuned-values -->\n{wanted}\n<!-- end -->" in page
