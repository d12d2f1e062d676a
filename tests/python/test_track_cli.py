"""`ebac track`: what it prints and writes, and how it refuses."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from ebac.cli import app
from ebac.plot import plot_tracking
from ebac.tracking import RecordedPath, evaluate, fit_circle, fit_line


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "160")


def ebac_command(*arguments: str) -> Any:
    return CliRunner().invoke(app, ["track", *arguments])


def points() -> Any:
    turn = np.linspace(0, 6, 300)
    circle = 0.04 * np.column_stack([np.cos(turn), np.sin(turn)])
    return circle + 1e-3 * np.random.default_rng(1).standard_normal((300, 2))


def write(name: str, heading: str = "x [mm],y [mm]", scale: float = 1e3) -> None:
    rows = "\n".join(f"{x!r},{y!r}" for x, y in (scale * points()).tolist())
    Path(name).write_text(f"{heading}\n{rows}\n")


def test_files_give_a_table_figures_and_numbers() -> None:
    write("circle.csv")
    done = ebac_command("circle.csv")
    assert done.exit_code == 0
    fit = fit_circle(points())
    assert f"{1e3 * fit.deviation.sd_m:.3f} mm" in done.stdout
    assert f"radius {1e3 * fit.radius:.3f} mm +- " in done.stdout
    assert "circle.csv: columns x, y in mm." in done.stdout
    assert {f.name for f in Path("ebac-track").iterdir()} == {"circle.png", "track.json"}


@pytest.mark.parametrize("shape", ["circle", "line"])
def test_errors_of_rounding_of_an_exact_path_are_printed_as_0(shape: str) -> None:
    turn = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    circle = 0.05 * np.column_stack([np.cos(turn), np.sin(turn)])
    line = np.outer(np.linspace(0, 0.1, 200), [1, 0.5])
    path = circle if shape == "circle" else line
    np.savetxt(f"{shape}.csv", path, "%.17g", ",", header="x [m],y [m]", comments="")
    out = " ".join(ebac_command(f"{shape}.csv", "--no-files").stdout.split())
    assert re.search(r"\+- 0 (mm|deg)", out), out
    fit = fit_circle(path) if shape == "circle" else fit_line(path)
    assert "SD 0 mm" in repr(fit)
    assert "e-" not in repr(fit)
    assert "-0.0000" not in repr(fit)


def test_json_has_the_documented_keys_and_writes_nothing() -> None:
    write("circle.csv")
    answer = json.loads(ebac_command("circle.csv", "--json").stdout)
    assert list(answer) == ["command", "version", "robust", "rows"]
    (row,) = answer["rows"]
    assert list(row) == [
        "file", "read", "shape", "points", "outliers", "independent_points", "sd_m", "error_m", "rms_m", "largest_m",
        "radius_m", "radius_sd_m", "arc_deg", "centre_m", "centre_sd_m",
        "out_of_plane_rms_m", "out_of_plane_largest_m",
    ]  # fmt: skip
    assert row["radius_m"] == pytest.approx(fit_circle(points()).radius)
    assert [f.name for f in Path().iterdir()] == ["circle.csv"]
    assert ebac_command("circle.csv").exit_code == 0
    assert json.loads(Path("ebac-track/track.json").read_text()) == answer


def test_two_files_of_one_name_keep_two_figures() -> None:
    for folder in ("a", "b"):
        Path(folder).mkdir()
        write(f"{folder}/run.csv")
    assert ebac_command("a/run.csv", "b/run.csv", "--shape", "line", "-o", "out").exit_code == 0
    assert {f.name for f in Path("out").iterdir()} == {"run-1.png", "run-2.png", "track.json"}


@pytest.mark.slow
def test_the_error_budget_stands_beside_the_table() -> None:
    done = ebac_command("--simulated", "--runs", "4")
    assert done.exit_code == 0
    for word in ("encoder", "installation", "cable slack", "1.460 mm", "assumptions", "Simulated"):
        assert word in done.stdout
    folder = Path("ebac-track")
    assert {f.name for f in folder.iterdir()} == {
        "budget.json",
        "budget.png",
        "line.png",
        "circle.png",
    }
    answer = json.loads((folder / "budget.json").read_text())
    assert [r["source"] for r in answer["rows"]].count("paper") == 6
    assert set(answer["slack_for_table_m"]) == {"line", "circle"}
    assert answer["assumed"]["slack_m"] == 0.5e-3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "give files to fit, or --simulated"),
        (["circle.csv", "--simulated"], "give files to fit, or --simulated"),
        (["nothing.csv"], "nothing.csv: there is no such file"),
        (["circle.csv", "--column", "x"], "--column = x: must be two or three, like x,y"),
        (["circle.csv", "--column", "x,w"], "circle.csv: column 'w': no such name; there are: "),
        (
            ["circle.csv", "--unit", "inches"],
            "--unit = 'inches': no such name, did you mean 'inch'; there are: m, mm, cm",
        ),
        (
            ["circle.csv", "--shape", "ellipse"],
            "--shape = 'ellipse': no such name; there are: auto, line, circle",
        ),
        (["--simulated", "--runs", "1"], "--runs = 1: must lie in [2, 100000]"),
        (["--simulated", "--slack", "0.1"], "--slack = 0.1 m: must lie in [0, 0.02] m"),
        (["--simulated", "--alignment", "-1"], "--alignment = -1: must lie in [0, 100]"),
        (["few.csv"], "few.csv: 2 points: a line needs at least 3"),
        (["."], "cannot be read (is a folder; give a file in it)"),
    ],
)
def test_bad_input_is_refused_and_nothing_is_written(arguments: list[str], message: str) -> None:
    write("circle.csv")
    Path("few.csv").write_text("x,y\n1,2\n2,3\n")
    done = ebac_command(*arguments)
    assert done.exit_code == 2
    assert message in " ".join(done.stderr.split())
    assert not Path("ebac-track").exists()


def ring(height: float) -> Any:
    """A ring of 40 mm in space [m] whose height goes up and down three times."""
    turn = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    return np.column_stack([0.04 * np.cos(turn), 0.04 * np.sin(turn), height * np.sin(3 * turn)])


def write_space(name: str, path: Any) -> None:
    rows = "\n".join(",".join(map(repr, row)) for row in (1e3 * path).tolist())
    Path(name).write_text(f"x [mm],y [mm],z [mm]\n{rows}\n")


def test_a_ring_that_leaves_its_plane_is_reported() -> None:
    write_space("bent.csv", ring(2e-3))
    (row,) = json.loads(ebac_command("bent.csv", "--json").stdout)["rows"]
    assert row["out_of_plane_rms_m"] == pytest.approx(2e-3 / np.sqrt(2), rel=1e-3)
    assert row["out_of_plane_largest_m"] == pytest.approx(2e-3, rel=1e-3)
    done = ebac_command("bent.csv")
    said = " ".join(done.stderr.split())
    assert "leaves the plane of its circle by 1.41 mm rms, 2 mm at most" in said
    assert "out of its plane" in " ".join(done.stdout.split())
    assert "out of its plane 1.41 mm rms" in repr(fit_circle(ring(2e-3)))


def test_a_ring_in_its_plane_is_not_blamed() -> None:
    noise = 1e-4 * np.random.default_rng(1).standard_normal((400, 3))
    write_space("flat.csv", ring(0) + noise)
    write("plane.csv")
    for name in ("flat.csv", "plane.csv"):
        assert "leaves the plane" not in ebac_command(name, "--no-files").stderr


def test_a_figure_in_space_names_what_it_shows() -> None:
    way = np.outer(np.linspace(0, 0.05, 300), [0.6, 0, 0.8])
    line = way + 1e-4 * np.random.default_rng(1).standard_normal((300, 3))
    for path, x in ((line, "along the fit [mm]"), (ring(0), "in the plane of the fit [mm]")):
        found = evaluate(RecordedPath(points=path, name="a", remark=""))
        figure = plot_tracking(found)
        left, _, right = figure.axes
        assert left.get_xlabel() == x
        if found.shape == "line":
            edge = max(patch.get_x() + patch.get_width() for patch in right.patches)
            assert edge == pytest.approx(1e3 * found.fit.deviation.largest_m)
            assert min(patch.get_x() for patch in right.patches) >= 0
            assert "normal, same SD" not in [drawn.get_label() for drawn in right.lines]
            assert right.get_xlabel() == "distance from the line [mm]"


def test_a_spiral_is_no_circle_for_auto() -> None:
    rising = ring(0)
    rising[:, 2] = np.linspace(0, 0.3, 400)
    assert evaluate(RecordedPath(points=rising, name="a", remark="")).shape == "line"
