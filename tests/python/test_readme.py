"""What the README claims is what the program says."""

import re
from pathlib import Path

import pytest

import ebac
from ebac.wording import verdict

README = Path(__file__).parents[2] / "README.md"


def table() -> dict[str, list[str]]:
    """The table of the first command: what each row says of tca, eba and ebac."""
    rows = re.findall(r"^\| ([^|]+) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|$", README.read_text(), re.M)
    return {name: cells for name, *cells in rows}


@pytest.mark.parametrize(("column", "law"), list(enumerate(("tca", "eba", "ebac"))))
def test_the_table_of_the_readme_is_what_the_wall_gives(column: int, law: str) -> None:
    wall = ebac.contact(ebac.simulate(ebac.Scenario(), law))
    told = {name: cells[column] for name, cells in table().items()}
    assert told["rest (ideal 1.165 mm)"] == f"{1e3 * wall.rest_m:.3f} mm"
    assert told["swing, peak to peak"] == f"{1e3 * wall.swing_m:.3f} mm"
    assert told["settled"] == ("never" if wall.settled_s is None else f"{wall.settled_s:.3f} s")
    assert told["least port energy"] == f"{1e3 * (wall.least_energy_J or 0):.0f} mJ"
    assert told["verdict"] == verdict(wall)


def test_the_first_two_blocks_are_one_command_each() -> None:
    blocks = re.findall(r"^```sh\n(.*?)^```", README.read_text(), re.M | re.S)
    assert [len(block.splitlines()) for block in blocks[:2]] == [1, 1]
