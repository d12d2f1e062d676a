"""What the README claims is what the program prints."""

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

import ebac
from ebac._util.formatting import verdict
from ebac.cli import app

README = Path(__file__).parents[2] / "README.md"
FIRST_WALL = README.parent / "docs/tutorials/first_wall.md"
LAWS = ("tca", "tca-damped", "eba", "ebac")
#: The two walls of the table: stiffness [N/m] and delay [samples].
WALLS = ((10e3, 1), (20e3, 2))


def table() -> list[list[str]]:
    """Return the cells of the table of four laws, six rows of numbers."""
    rows = re.findall(
        r"^\|([^|]+)\|([^|]+)\|([^|]+)\|([^|]+)\|([^|]+)\|$", README.read_text(), re.M
    )
    return [[cell.strip() for cell in cells] for cells in rows][2:]


@pytest.mark.parametrize("wall", [0, 1])
@pytest.mark.parametrize(("column", "law"), list(enumerate(LAWS, 1)))
def test_the_table_is_what_the_walls_give(wall: int, column: int, law: str) -> None:
    stiffness, delay = WALLS[wall]
    scenario = ebac.Scenario(
        environment=ebac.Wall(stiffness=stiffness), timing=ebac.Timing(dt=1e-3, delay=delay)
    )
    found = ebac.contact(ebac.simulate(scenario, law))
    words, settled, energy = table()[3 * wall : 3 * wall + 3]
    assert f"{stiffness / 1e3:g} kN/m, {delay} sample" in words[0]
    assert words[column] == verdict(found)
    assert settled[column] == ("never" if found.settled_s is None else f"{found.settled_s:.3f} s")
    mJ = 1e3 * (found.least_energy_J or 0)
    assert energy[column] == (f"{mJ:.1f} mJ" if -1 < mJ < 0 else f"{mJ:.0f} mJ")


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
