"""Soft materials against their closed forms, and `ebac tissue`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from ebac.cli import app
from ebac.plot import plot_tissue
from ebac.studies import Tissue, tissue
from ebac.studies.tissue import materials
from ebac.worlds import Elastic, HuntCrossley, Layer, Layered, force_depth
from ebac.worlds.force_depth import ForceDepth

#: Of a path of 6000 rows: a step of 2 um, over which a force of some newtons drops.
SOFT = 2e-5


@pytest.fixture(scope="module")
def found() -> Tissue:
    return tissue(laws=("direct", "ebac"))


def assert_is_its_closed_form(curve: ForceDepth) -> None:
    assert curve.error < 1e-9
    step = curve.depth.max() / 6000
    assert len(curve.punctures) == len(curve.punctures_exact)
    for one, exact in zip(curve.punctures, curve.punctures_exact, strict=True):
        assert 0 <= one.depth - exact.depth <= step * (1 + 1e-9)
        assert one.after == pytest.approx(exact.after, abs=1e3 * step)
    assert curve.taken == pytest.approx(curve.taken_exact, rel=1e-3, abs=SOFT)
    assert curve.back == pytest.approx(curve.back_exact, rel=1e-3, abs=SOFT)
    assert curve.back <= curve.taken + 1e-12


@pytest.mark.parametrize("name", materials())
@pytest.mark.parametrize("speed", [2e-3, 0.02, 0.2])
def test_every_material_is_its_closed_form(name: str, speed: float) -> None:
    assert_is_its_closed_form(force_depth(materials()[name], speed=speed))


layer = st.builds(
    Layer,
    thickness=st.floats(5e-4, 8e-3),
    stiffness=st.floats(0, 1000),
    damping=st.floats(0, 5),
    puncture=st.just(0.0) | st.floats(0.5, 3),
    cutting=st.floats(0, 0.4),
)


@given(st.lists(layer, min_size=1, max_size=6), st.floats(2e-3, 0.1))
@settings(max_examples=12)
@pytest.mark.slow
def test_layers_of_any_kind_are_their_closed_form(layers: list[Layer], speed: float) -> None:
    curve = force_depth(Layered(*layers), speed=speed)
    assert curve.error < 1e-9
    assert curve.taken == pytest.approx(curve.taken_exact, rel=1e-2, abs=SOFT)
    assert curve.back == pytest.approx(curve.back_exact, rel=1e-2, abs=SOFT)


def test_a_puncture_drops_the_force_to_what_is_below(found: Tissue) -> None:
    first, second = found.curves["layered"].punctures
    assert (first.before, first.after) == pytest.approx((3.0, 0.3), abs=5e-3)
    assert (second.before, second.after) == pytest.approx((2.0 + 0.3, 0.3 + 0.2), abs=5e-3)


def test_what_a_spring_takes_it_gives_back_and_a_damper_does_not() -> None:
    spring = force_depth(Elastic(stiffness=500), depth=0.01)
    assert spring.back == pytest.approx(spring.taken) == pytest.approx(0.025)
    lossy = force_depth(HuntCrossley(dissipation=10.0), speed=0.2)  # 3/2 a v = 3
    assert lossy.back == pytest.approx(0, abs=1e-12)


def test_no_law_gives_out_energy_of_a_soft_material(found: Tissue) -> None:
    assert [(row.material, row.law) for row in found.rows] == [
        (name, law) for name in materials() for law in ("direct", "ebac")
    ]
    for row in found.rows:
        assert row.passive, row
        assert row.deepest_m > 4e-3
        assert row.force_error_N < 1.0
        assert row.kept_J > row.own_loss_J - 4e-3


def test_its_figure_has_the_curves_and_a_row_for_each_law(found: Tissue) -> None:
    figure = plot_tissue(found)
    assert [len(ax.lines) for ax in figure.axes[:4]] == [3] * 4
    assert all(len(ax.lines) in (1, 2) for ax in figure.axes[4:])
    assert [ax.get_ylabel().split("\n")[0] for ax in figure.axes[::4]] == [
        "material",
        "direct",
        "ebac",
    ]
    swaying = tissue(laws=("tca-damped", "ebac"), chosen={"soft": Elastic(stiffness=1000.0)})
    curves, swings, still = plot_tissue(swaying).axes
    assert swings.get_ylim() == still.get_ylim() != curves.get_ylim()
    pale, *lines = swings.lines
    assert pale.get_alpha() < 0.5  # its mean stands out
    ways = [np.abs(np.diff(line.get_ydata())).sum() for line in (pale, lines[0])]
    assert ways[1] < 0.1 * ways[0]
    alone = tissue(laws=(), chosen={"soft": HuntCrossley()})
    assert len(plot_tissue(alone).axes) == 1


@pytest.mark.slow
def test_the_command_gives_the_numbers_with_their_units(tmp_path: Path) -> None:
    words = ["tissue", "--law", "ebac", "--depth", "0.01", "--json", "--out", str(tmp_path / "t")]
    answer = CliRunner().invoke(app, words)
    assert answer.exit_code == 0, answer.output
    document = json.loads(answer.stdout)
    assert [row["material"] for row in document["rows"]] == list(materials())
    assert {row["law"] for row in document["laws"]} == {"ebac"}
    assert np.isclose(document["rows"][0]["taken_J"], 0.05)
    assert (tmp_path / "t" / "tissue.png").exists()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ("tissue --speed 0.001", "speed = 0.001 m/s: must lie in [0.002, 1] m/s"),
        ("tissue --depth 1", "depth = 1 m: must lie in [0.0001, 0.1] m"),
    ],
)
def test_a_number_out_of_range_is_refused(words: str, says: str) -> None:
    answer = CliRunner().invoke(app, words.split())
    assert answer.exit_code == 2
    assert says in " ".join(answer.output.split())


def test_what_is_no_material_is_refused() -> None:
    with pytest.raises(TypeError, match=r"Body.material = 3"):
        force_depth(3)  # type: ignore[arg-type]
