"""`ebac engines` and `ebac.studies.engines`: what must be shown of an engine at 60 and 500 Hz."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.plot import plot_engines
from ebac.studies import Engines, engines
from ebac.worlds import Bridge, EngineThread, LocalModel


@pytest.fixture(scope="module")
def found() -> Engines:
    return engines(laws=("direct", "tca-damped", "passivity-control", "ebac"))


def test_a_local_model_is_the_world_itself_and_a_held_force_shakes(found: Engines) -> None:
    assert len(found.rows) == 4 * 5
    for law in ("direct", "tca-damped", "passivity-control", "ebac"):
        rows = [row for row in found.rows if row.law == law]
        plain = rows[0]
        for row in rows[1:]:
            if row.rendered == "local model":  # a plane that stands still is its own model
                assert row.swing_m == pytest.approx(plain.swing_m, abs=1e-5)
                assert (row.quiet, row.exact, row.passive) == (
                    plain.quiet,
                    plain.exact,
                    plain.passive,
                )
            elif law == "ebac":  # does not shake, but rests too deep
                assert row.still
                assert row.passive
                assert not row.exact
            else:
                assert not row.still
                assert not row.passive
    best = [row for row in found.rows if row.law == "ebac" and row.rendered == "local model"]
    assert all(row.quiet and row.exact and row.passive for row in best)
    assert best[0].oldest_s == pytest.approx(2 / 60 + 0.01, abs=2e-3)


def test_a_figure_shows_all_laws_and_rates(found: Engines) -> None:
    figure = plot_engines(found)
    assert len(figure.axes) == 4 * 2
    assert all(len(ax.lines) == 4 for ax in figure.axes)  # three runs and the ideal rest
    assert [text.get_text()[:4] for text in figure.axes[0].texts] == ["cut:"]  # a held force shakes


def test_the_command_says_the_same_as_json(tmp_path: Path) -> None:
    call = [
        "engines",
        "--law",
        "ebac",
        "--engine-rate",
        "60",
        "--json",
        "--out",
        str(tmp_path / "e"),
    ]
    answer = CliRunner().invoke(app, call)
    assert answer.exit_code == 0, answer.output
    rows = json.loads(answer.stdout)["rows"]
    assert [row["rendered"] for row in rows] == ["every tick", "force held", "local model"]
    assert (tmp_path / "e" / "engines.png").exists()


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (["wall", "--engine-held"], "--engine-held: needs an engine; add --engine-rate 60"),
        (["wall", "--engine-rate", "0.1"], "--engine-rate = 0.1 Hz: must lie in [1, 1000] Hz"),
        (["engines", "--engine-jitter", "2"], "--engine-jitter = 2 s: must lie in [0, 1] s"),
        (["engines", "--engine-rate", "1000", "--engine-jitter", "1"], "62 answers"),
    ],
)
def test_what_cannot_be_is_refused_by_the_name_of_its_option(call: list[str], says: str) -> None:
    answer = CliRunner().invoke(app, call)
    assert answer.exit_code == 2
    assert says in " ".join(answer.output.split())


def test_a_wall_of_ebac_wall_may_have_an_engine(tmp_path: Path) -> None:
    call = [
        "wall",
        "--law",
        "ebac",
        "--engine-rate",
        "60",
        "--seconds",
        "1",
        "--wall-position",
        "0.01",
    ]
    answer = CliRunner().invoke(app, [*call, "--out", str(tmp_path / "w")])
    assert answer.exit_code == 0, answer.output
    scenario = ebac.Scenario.load(tmp_path / "w" / "scenario.toml")
    assert isinstance(scenario.environment, Bridge)
    assert scenario.environment.timing.compute == pytest.approx(1 / 60)


def test_a_world_that_no_engine_computes_is_refused() -> None:
    with pytest.raises(ValueError, match=r"an engine computes a worlds\.World"):
        engines(base=ebac.Scenario(environment=ebac.Disc()))
    thread = EngineThread(lambda x, v: LocalModel(at=(0, 0, 0), normal=(1, 0, 0), stiffness=1))
    with pytest.raises(ValueError, match="an engine computes"):
        engines(base=ebac.Scenario(environment=thread.world))


def test_a_damping_that_the_model_would_leave_out_is_refused() -> None:
    words = "wall --wall-damping 10 --engine-rate 60 --law ebac --no-files"
    result = CliRunner().invoke(app, words.split())
    assert result.exit_code == 2
    assert "damping = 10 N s/m: must be 0 N s/m behind an engine" in result.output
