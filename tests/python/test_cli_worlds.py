"""Worlds on the command line: `ebac wall --world` and `ebac worlds`."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from ebac.cli import app
from ebac.worlds import PRESETS, HeightField
from ebac.worlds.grid import watching


def ran(words: str, code: int = 0) -> str:
    result = CliRunner().invoke(app, words.split())
    assert result.exit_code == code, result.output
    return result.output


def row(words: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(ran(f"{words} --json"))["rows"][0]
    return found


def test_a_table_says_how_the_bodies_were_met() -> None:
    table = ran("wall --world sphere --law ebac --no-files")
    for line in ("depth", "normal error", "stored at most", "ticks come through"):
        assert line in table
    assert "every world is met head-on, as a wall" in " ".join(table.split())
    assert "head-on" not in ran("wall --world sphere --device joystick-3 --law ebac --no-files")
    assert "normal error" not in ran("wall --law ebac --no-files")


def test_numbers_of_the_bodies_are_those_of_the_port() -> None:
    found = row("wall --world sphere --law ebac --no-files")
    assert found["world"]["depth_m"] == pytest.approx(found["rest_m"], rel=1e-3)
    assert found["world"]["stored_J"] == pytest.approx(0.5 * 1e4 * found["peak_m"] ** 2, rel=1e-6)
    assert found["world"]["came_through"] == 0


def test_a_name_that_is_none_is_said_once() -> None:
    assert "Error: world 'grond': no such name, did you mean 'ground'" in ran("worlds grond", 2)
    assert "Error: --world 'grond': no such name" in ran("wall --world grond --no-files", 2)


@pytest.mark.parametrize("world", ["soft", "tissue"])
def test_a_material_of_its_own_takes_no_stiffness(world: str) -> None:
    said = ran(f"wall --world {world} --wall-stiffness 100 --no-files", 2)
    assert "has a material of its own: give no stiffness" in said


def test_every_world_is_listed_with_what_it_needs() -> None:
    rows = json.loads(ran("worlds --json"))["rows"]
    assert [one["name"] for one in rows] == [*PRESETS, "mesh:FILE"]


def test_a_grid_in_the_making_calls_whoever_watches(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("igl")
    monkeypatch.setenv("EBAC_CACHE", str(tmp_path))
    hills = HeightField(heights=((0.0, 0.001), (0.0, 0.002)), spacing=0.02, cell=1e-3)
    seen: list[tuple[int, int]] = []
    with watching(lambda done, total: seen.append((done, total))):
        hills.grid()
        hills.grid()  # from the cache
    done, total = zip(*seen, strict=True)
    assert list(done) == sorted(set(done))
    assert done[-1] == total[-1] > 0


def test_without_the_extra_a_sentence_names_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "igl", None)
    assert "pip install 'ebac[worlds]'" in ran("wall --world ground --no-files", 2)


def test_what_a_handle_meets_at_places() -> None:
    inside, outside = json.loads(ran("worlds sphere --at 0.001,0,0 --at -0.01,0,0 --json"))["rows"]
    assert inside["force_N"] == pytest.approx([10, 0, 0], abs=1e-9)
    assert inside["normal"] == pytest.approx([1, 0, 0])
    assert (inside["depth_m"], inside["stiffness_N_per_m"]) == pytest.approx((1e-3, 1e4))
    assert inside["distance_m"] == pytest.approx(-1e-3)
    assert outside["distance_m"] == pytest.approx(0.01)
    assert outside["force_N"] == [0, 0, 0]
    assert outside["normal"] is None


def test_every_number_at_a_place_has_its_unit() -> None:
    shown = ran("worlds sphere --at 0.001,0,0")
    for cell in ("1 0 0 mm", "-1.000 mm", "1.000 mm", "10 0 0 N", "1 0 0", "10000 N/m"):
        assert f" {cell} " in f" {shown} ", cell


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("worlds sphere --at 1,2", "--at 1,2: must be three numbers in m, without a unit"),
        ("worlds sphere --at 1mm,0,0", "1 mm along x is 0.001,0,0"),
        ("worlds sphere --at nan,0,0", "--at nan,0,0: each must lie in [-1, 1] m"),
        ("worlds --at 0,0,0", "in which world?"),
    ],
)
def test_places_that_are_none(words: str, said: str) -> None:
    assert said in ran(words, 2)


def test_a_place_that_is_likely_meant_in_millimetres_is_noted() -> None:
    noted = ran("worlds sphere --at 1,0,0")
    assert "positions are in metres, these in mm are 0.001,0,0" in " ".join(noted.split())
    assert "in metres" not in ran("worlds sphere --at 0.03,0,0")
