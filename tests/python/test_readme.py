"""What the README claims is what the program prints."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.studies.conditions import conditions as find

README = Path(__file__).parents[2] / "README.md"
FIRST_WALL = README.parent / "docs/tutorials/first_wall.md"


def table() -> list[list[str]]:
    """Return the cells of the table of four laws, eight rows of numbers for each wall."""
    rows = re.findall("^" + 5 * r"\|([^|\n]+)" + r"\|$", README.read_text(), re.M)
    return [[cell.strip() for cell in cells] for cells in rows][2:]


def test_the_table_is_what_the_study_gives() -> None:
    command = re.search(r"^ebac (study .*--device-noise.*)$", README.read_text(), re.M)
    assert command
    result = CliRunner().invoke(app, [*command[1].split(), "--json"])
    by_wall: dict[str, list[dict[str, Any]]] = {}
    for row in json.loads(result.stdout)["rows"]:
        by_wall.setdefault(row["condition"], []).append(row)
    for (name, rows), place in zip(by_wall.items(), (0, 8), strict=True):
        still, good, settled, in_time, impact, energy = table()[place : place + 6]
        change = find([name])[0].change(ebac.Scenario())
        wall, timing = change.environment, change.timing
        assert isinstance(wall, ebac.Wall)
        assert f"{wall.stiffness / 1e3:g} kN/m, {timing.delay} sample" in still[0]
        assert [row["law"] for row in rows] == [
            "tca",
            "tca-damped",
            "lag-compensator-tuned-observer",
            "ebac",
        ]
        assert still[1:] == [str(row["exact_and_still"]) for row in rows]
        assert good[1:] == [str(row["good"]) for row in rows]
        assert settled[1:] == [_seconds(row["median_settled_s"]) for row in rows]
        assert in_time[1:] == [str(row["settled_in_time"]) for row in rows]
        assert impact[1:] == [f"{100 * row['median_impact_share']:.0f} %" for row in rows]
        assert energy[1:] == [_energy(row["least_energy_J"]) for row in rows]


@pytest.mark.slow
@pytest.mark.weekly
@pytest.mark.parametrize(("condition", "place"), [("d1K10", 6), ("d2K20", 14)])
def test_the_worst_hands_of_the_table_are_those_that_are_found(condition: str, place: int) -> None:
    what, *shown = table()[place]
    assert what == "drawn by the worst hand of a search"
    noisy = ebac.Scenario(device=ebac.Device(sensor=ebac.ForceSensor(noise=0.03)))
    laws = ["tca", "tca-damped", "lag-compensator-tuned-observer", "ebac"]
    found = [ebac.worst(law, condition, base=noisy).hands for law in laws]
    assert shown == [_drawn(hands[0].energy_J) for hands in found]
    what, *shown = table()[place + 1]
    assert what == "and if such a hand goes on for 5 min"
    assert shown == [_drawn(max(hand.long_energy_J for hand in hands)) for hands in found]


def _drawn(joule: float) -> str:
    if joule >= 1000:  # where a run ends
        return "> 1 kJ"
    if joule >= 100:
        return f"{joule:.0f} J"
    if joule >= 1:
        return f"{joule:.1f} J"
    return f"{1e3 * joule:.0f} mJ" if joule >= 0.01 else f"{1e3 * joule:.1f} mJ"


def _seconds(value: float | None) -> str:
    return "never" if value is None else f"{value:.3f} s"


def _energy(joule: float) -> str:
    if joule < -1:
        return f"{joule:.1f} J"
    return "0 mJ" if joule > -5e-8 else f"{1e3 * joule:.1f} mJ"


@pytest.mark.parametrize("page", [README, FIRST_WALL], ids=lambda page: page.name)
def test_the_first_command_prints_what_is_shown(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(app, ["wall", "--no-files"])
    printed = [line.split() for line in result.output.splitlines()]
    block = re.search(r"^```text\n(.*?)^```", page.read_text(), re.M | re.S)
    assert block
    for line in block[1].splitlines():
        assert line.split() in printed


def test_the_python_example_prints_what_is_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    text = README.read_text()
    code = re.search(r"^```python\n(.*?)^```", text, re.M | re.S)
    _, shown = re.findall(r"^```text\n(.*?)^```", text, re.M | re.S)
    assert code
    exec(code[1], {})
    assert capsys.readouterr().out.startswith(shown)


def test_the_first_two_blocks_are_one_command_each() -> None:
    blocks = re.findall(r"^```sh\n(.*?)^```", README.read_text(), re.M | re.S)
    assert [len(block.splitlines()) for block in blocks[:2]] == [1, 1]
