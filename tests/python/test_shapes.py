"""`ebac shapes` and `ebac.shapes`: laws at several shapes, on one to three axes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.metrics.world_rest import world_rest
from ebac.plot import plot_shapes
from ebac.studies import Shapes, shapes
from ebac.studies.shapes import TARGET
from ebac.worlds import preset


@pytest.fixture(scope="module")
def found() -> Shapes:
    return shapes(("direct", "ebac"), worlds=("sphere", "corner", "soft"))


@pytest.mark.slow
def test_ebac_is_good_everywhere_and_direct_swings_where_it_is_stiff(found: Shapes) -> None:
    assert len(found.rows) == 2 * 3 * (2 + 2 + 1)
    for row in found.rows:
        if row.law == "ebac":
            assert row.good, row
        elif row.stiffness_N_per_m == 10e3:
            assert not row.still
            assert not row.passive
            assert (row.swing_m or 0) > 1e-3
    assert {row.axes for row in found.rows} == {1, 2, 3}
    assert {row.stiffness_N_per_m for row in found.rows if row.world == "soft"} == {None}


@pytest.mark.slow
def test_ebac_is_good_with_a_noisy_sensor_as_well() -> None:
    """Two and three axes, 10 kN/m; on the encoder alone its force clicks."""
    worlds, devices = ("sphere", "corner"), ("joystick", "joystick-3")
    found = shapes(("ebac",), worlds=worlds, stiffnesses=(10e3,), devices=devices, noise=0.03)
    assert found.noise_N == 0.03
    assert all(row.good for row in found.rows), found.rows
    plain = shapes(("ebac",), worlds=worlds, stiffnesses=(10e3,), devices=devices)
    assert all(
        (a.perceived or 0) > (b.perceived or 0) for a, b in zip(found.rows, plain.rows, strict=True)
    )


@pytest.mark.slow
def test_a_figure_has_a_panel_for_each_stiffness(found: Shapes) -> None:
    figure = plot_shapes(found)
    assert len(figure.axes) == 3
    assert len(figure.axes[0].texts) == 2 * 2 * 3


@pytest.mark.parametrize("position", [0.0, 0.01])
def test_a_gimbal_has_a_rest_in_a_world(position: float) -> None:
    """A slow hand ends where the balance says; the joystick's handle is heavy and moves on a sphere."""
    device = ebac.presets.device("joystick")
    hand = ebac.Hand(path=[ebac.MinimumJerk(target=x, duration=2.0) for x in TARGET[:2]])
    world = preset("sphere", stiffness=1000, damping=5, position=position)
    scenario = ebac.Scenario(device=device, hand=hand, environment=world, seconds=5)
    end = ebac.simulate(scenario, "direct")[4.8:]["true.x"].mean(axis=0)
    rest = world_rest(scenario)
    assert rest is not None
    assert end == pytest.approx(rest.place, abs=2 * device.count)


def test_a_rest_on_facets_is_the_one_nearby() -> None:
    pytest.importorskip("igl")
    pytest.importorskip("trimesh")
    rows = shapes(("ebac",), worlds=("mesh",), devices=("joystick-3",)).rows
    assert all(row.good for row in rows), rows


def test_the_command_says_the_same_as_json(tmp_path: Path) -> None:
    call = "shapes --world edge --stiffness 10000 --device joystick --law direct,ebac --json --out"
    answer = CliRunner().invoke(app, [*call.split(), str(tmp_path / "s")])
    assert answer.exit_code == 0, answer.output
    document = json.loads(answer.stdout)
    direct, ours = document["rows"]
    assert (document["noise_N"], document["lag_s"]) == (0, 0.8e-3)
    assert (direct["still"], ours["quiet"], ours["exact"], ours["passive"]) == (
        False, True, True, True,
    )  # fmt: skip
    assert {file.name for file in (tmp_path / "s").iterdir()} == {
        "shapes.json", "shapes.csv", "shapes.png",
    }  # fmt: skip
    table = ["shapes", *call.split()[1:-2], "--out", str(tmp_path / "t")]
    answer = CliRunner().invoke(app, table)
    assert "swings" in answer.output
    assert "good" in answer.output
    assert "the force sensor without noise" in " ".join(answer.output.split())
    table = [*table[:-1], str(tmp_path / "u"), "--device-noise", "0.03", "--device-lag", "0.003"]
    answer = CliRunner().invoke(app, table)
    assert "the force sensor with 0.03 N of noise, its filter 3 ms" in " ".join(
        answer.output.split()
    )


@pytest.mark.parametrize(
    ("call", "says"),
    [
        ("--world ball", "--world 'ball': no such name"),
        ("--device stick", "--device stick"),
        ("--stiffness -1", "stiffness = -1 N/m: must lie in [0, 1e+07] N/m"),
        ("--law best", "--law best"),
        ("--device-noise -1", "--device-noise = -1 N: must lie in [0, 100] N"),
        ("--device-lag 3", "--device-lag = 3 s: must lie in [0, 0.1] s"),
    ],
)
def test_what_cannot_be_is_refused(
    call: str, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    answer = CliRunner().invoke(app, ["shapes", *call.split()])
    assert answer.exit_code == 2
    assert says in " ".join(answer.output.split())


def test_nothing_to_compare_is_refused() -> None:
    with pytest.raises(ValueError, match=r"worlds = \[\]: is empty; give one at least"):
        shapes(worlds=())
