"""Line and circle fits, their uncertainty, and the error budget beside Table I of the paper."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import ebac
from ebac.tracking import (
    TABLE_I,
    CircleFit,
    ErrorSources,
    LineFit,
    error_budget,
    evaluate,
    fit_circle,
    fit_line,
    read_path,
)
from ebac.tracking.error_sources import Joystick, nominal_joints

Numbers = NDArray[np.float64]

seeds = st.integers(0, 2**31)
angles = st.floats(-math.pi, math.pi)
places = st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1))
scales = st.floats(0.1, 100)
FITS: dict[str, Any] = {"line": fit_line, "circle": fit_circle}


def turned(points: Numbers, angle: float) -> Numbers:
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def in_space(points: Numbers, seed: int) -> tuple[Numbers, Numbers]:
    """Points of a plane somewhere in space, and the rotation."""
    turn, _ = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    return np.column_stack([points, np.zeros(len(points))]) @ turn.T, turn


def noisy(shape: str, seed: int, n: int = 60, sd: float = 5e-4) -> Numbers:
    random = np.random.default_rng(seed)
    if shape == "line":
        path = np.column_stack([np.linspace(-0.04, 0.04, n), np.zeros(n)])
    else:
        turn = np.linspace(0, 5, n)
        path = 0.04 * np.column_stack([np.cos(turn), np.sin(turn)])
    return np.asarray(path + sd * random.standard_normal((n, 2)))


# --- exact ---


@given(
    angle=angles,
    place=places,
    n=st.integers(3, 50),
    length=st.floats(1e-3, 1),
    robust=st.booleans(),
)
def test_a_line_without_noise_is_found_exactly(
    angle: float, place: tuple[float, float], n: int, length: float, robust: bool
) -> None:
    way = np.column_stack([np.linspace(0, length, n), np.zeros(n)])
    fit = fit_line(turned(way, angle) + place, robust=robust)
    assert fit.direction == pytest.approx((math.cos(angle), math.sin(angle)), abs=1e-9)
    middle = np.array(place) + 0.5 * length * fit.direction
    assert fit.point == pytest.approx(middle, abs=1e-9)
    assert fit.deviation.largest_m < 1e-12
    assert fit.deviation.outliers == 0


@pytest.mark.slow
@given(
    place=places,
    radius=st.floats(1e-3, 1),
    start=angles,
    arc=st.floats(0.3, 6.28),
    n=st.integers(4, 50),
    robust=st.booleans(),
)
def test_a_circle_without_noise_is_found_exactly(
    place: tuple[float, float], radius: float, start: float, arc: float, n: int, robust: bool
) -> None:
    turn = start + np.linspace(0, arc, n)
    fit = fit_circle(np.column_stack([np.cos(turn), np.sin(turn)]) * radius + place, robust=robust)
    assert fit.radius == pytest.approx(radius, rel=1e-6)
    assert fit.centre == pytest.approx(place, abs=1e-6 * radius + 1e-12)
    assert fit.deviation.largest_m < 1e-9 * radius + 1e-12


# --- invariance ---


@pytest.mark.parametrize("shape", FITS)
@pytest.mark.parametrize("robust", [False, True])
@settings(max_examples=8)
@given(seed=seeds, angle=angles, place=places, scale=scales)
@pytest.mark.slow
def test_a_fit_moves_turns_and_grows_with_its_points(
    shape: str, robust: bool, seed: int, angle: float, place: tuple[float, float], scale: float
) -> None:
    points = noisy(shape, seed)
    one = FITS[shape](points, robust=robust)
    other = FITS[shape](scale * turned(points, angle) + place, robust=robust)
    assert (one.inliers == other.inliers).all()
    for name in ("sd_m", "error_m", "rms_m", "largest_m"):
        assert getattr(other.deviation, name) == pytest.approx(
            scale * getattr(one.deviation, name), rel=1e-5
        )
    assert other.residuals == pytest.approx(scale * one.residuals, abs=1e-7 * scale)
    if shape == "circle":
        assert other.radius == pytest.approx(scale * one.radius, rel=1e-6)
        assert other.centre == pytest.approx(
            scale * turned(one.centre, angle) + place, abs=1e-6 * scale
        )
    else:
        assert other.direction == pytest.approx(turned(one.direction, angle), abs=1e-6)
        assert other.point == pytest.approx(
            scale * turned(one.point, angle) + place, abs=1e-6 * scale
        )


@pytest.mark.parametrize("shape", FITS)
@settings(max_examples=30)
@given(seed=seeds)
def test_in_space_the_same_path_has_the_same_fit(shape: str, seed: int) -> None:
    points = noisy(shape, seed)
    space, turn = in_space(points, seed)
    flat, other = FITS[shape](points), FITS[shape](space)
    assert other.deviation.sd_m == pytest.approx(flat.deviation.sd_m, rel=1e-6)
    if shape == "circle":
        assert other.radius == pytest.approx(flat.radius, rel=1e-6)
        assert other.centre == pytest.approx(turn @ [*flat.centre, 0], abs=1e-7)
        assert abs(other.normal @ turn[:, 2]) == pytest.approx(1, abs=1e-9)
        assert np.abs(other.out_of_plane).max() < 1e-12
    else:
        assert other.direction == pytest.approx(turn @ [*flat.direction, 0], abs=1e-7)


# --- uncertainty ---


@pytest.mark.parametrize("shape", FITS)
def test_intervals_cover_the_truth(shape: str) -> None:
    """95 % intervals in 400 paths with independent noise: 93 to 97.5 % within two standard errors of 95 %."""
    covered = []
    for seed in range(400):
        fit = FITS[shape](noisy(shape, seed, n=80))
        if shape == "line":
            covered.append(abs(fit.angle_rad) <= 1.96 * fit.direction_sd_rad)
        else:
            covered.append(abs(fit.radius - 0.04) <= 1.96 * fit.radius_sd_m)
    assert 0.92 <= np.mean(covered) <= 0.98


@pytest.mark.parametrize("end", [0.0, -0.0, -1e-18])
def test_a_line_to_the_left_has_the_angle_pi_never_minus_pi(end: float) -> None:
    assert fit_line([[2, 0], [1, 0], [0, end]]).angle_rad == math.pi


def test_a_path_recorded_ten_times_as_often_knows_no_more() -> None:
    once = noisy("circle", 3, n=200)
    often = np.repeat(once, 10, axis=0)
    one, ten = fit_circle(once), fit_circle(often)
    assert ten.deviation.n == 10 * one.deviation.n
    assert ten.radius_sd_m == pytest.approx(one.radius_sd_m, rel=0.25)


def test_a_short_arc_says_how_little_it_knows() -> None:
    turn = np.linspace(0, 0.4, 200)
    random = np.random.default_rng(1)
    arc = 0.04 * np.column_stack([np.cos(turn), np.sin(turn)]) + 1e-4 * random.standard_normal(
        (200, 2)
    )
    fit = fit_circle(arc)
    assert fit.arc_rad == pytest.approx(0.4, abs=0.02)
    assert fit.radius_sd_m > 20 * fit_circle(noisy("circle", 1, n=200, sd=1e-4)).radius_sd_m


def test_the_numbers_are_those_of_their_definitions() -> None:
    points = np.array([[0, 1], [1, -1], [2, -1], [3, 1]], float)  # the line is y = 0
    d = fit_line(points).deviation
    assert (d.n, d.sd_m, d.error_m, d.rms_m, d.largest_m) == pytest.approx(
        (4, math.sqrt(2), 1, 1, 1)
    )


def test_the_table_allows_the_mean_distance_and_no_largest_one() -> None:
    ratios = [entry.ratio for entry in TABLE_I]
    assert max(ratios) < 1  # neither the largest deviation nor the root mean square
    assert min(ratios) > 0.63
    assert max(ratios) < 0.89
    wave = fit_line(
        np.column_stack([np.linspace(0, 1, 4000), 1e-3 * np.sin(np.linspace(0, 40 * np.pi, 4000))])
    )
    assert wave.deviation.error_m / wave.deviation.sd_m == pytest.approx(
        2 * math.sqrt(2) / math.pi, abs=2e-3
    )
    x = np.linspace(-1, 1, 4000)
    bow = fit_line(np.column_stack([x, 1e-3 * x**2]))
    assert bow.deviation.error_m / bow.deviation.sd_m == pytest.approx(0.861, abs=2e-3)


# --- bad points ---


@pytest.mark.parametrize("shape", FITS)
@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([[0, 0], [1, 1]], "2 points: a .* needs at least"),
        (np.zeros((20, 2)), "all 20 points are the same: the signal is constant"),
        ([[0, 0], [1, math.nan], [2, 2], [3, 3], [1, 2]], r"point 1 is \(1.0, nan\): every coordinate must be finite"),
        (np.zeros(20), r"shape \(20,\): must be \(n, 2\) or \(n, 3\)"),
        ([["a", "b"]] * 5, "must be numbers"),
    ],
)  # fmt: skip
def test_what_cannot_be_fitted_is_refused(shape: str, points: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        FITS[shape](points)


@given(angle=angles, robust=st.booleans())
@settings(max_examples=20)
def test_a_line_is_no_circle(angle: float, robust: bool) -> None:
    way = np.column_stack([np.linspace(-1, 1, 50), np.zeros(50)])
    with pytest.raises(ValueError, match="lie on a line: their circle has no radius"):
        fit_circle(turned(way, angle), robust=robust)


def test_a_whole_circle_is_no_line() -> None:
    turn = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    with pytest.raises(ValueError, match="spread alike in all directions"):
        fit_line(np.column_stack([np.cos(turn), np.sin(turn)]))


# --- files ---


def write(path: Path, heading: str, points: Numbers) -> Path:
    rows = (",".join(map(repr, map(float, p))) for p in points)
    path.write_text("\n".join([heading, *rows, ""]))
    return path


@pytest.mark.parametrize(
    ("heading", "scale", "said"),
    [
        ("x [mm],y [mm]", 1e3, "columns x, y in mm"),
        ("x_mm,y_mm", 1e3, "columns x, y in mm"),
        ("X (cm),Y (cm)", 1e2, "columns X, Y in cm"),
        ("x [\u00b5m],y [\u03bcm]", 1e6, "columns x, y in um"),
        ("x,y", 1e3, "columns x, y in mm (no unit given; mm guessed from the size, --unit to change it)"),
        ("x,y", 1, "columns x, y in m (no unit given; m guessed"),
    ],
)  # fmt: skip
def test_units_are_read_or_guessed_and_said(
    tmp_path: Path, heading: str, scale: float, said: str
) -> None:
    path = read_path(write(tmp_path / "a.csv", heading, scale * noisy("circle", 1)))
    assert path.remark.startswith(said)
    assert path.points == pytest.approx(noisy("circle", 1), rel=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file is empty"),
        ("x,y\n", "has no rows below its heading"),
        ("t,a\n1,2\n", "no columns x and y among t, a: name them with columns=[...], or --column"),
        ("x,y\n1,2\n3,oops\n", "column y, row 2: 'oops' is no number"),
        ("x,y\n1,2\n3,nan\n", "column y, row 2: nan is not finite"),
        ("x,y\n1,2\n3\n", "row 2 has 1 values, the heading 2"),
        ("x [mm],y [m]\n1,2\n", "have several units"),
        (
            "x y\n1 2\n",
            "its columns have spaces between them; put commas, semicolons or tabs there",
        ),
        ("To do\nbuy a cable\nat 5\ngo home\nor to the sea\n", "is no table of numbers"),
        ("To do\nbuy cable\ngo home\n", "is no table of numbers"),
    ],
)
def test_a_bad_file_is_told_by_name_and_place(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "bad.csv"
    file.write_text(text)
    with pytest.raises(ValueError) as caught:  # noqa: PT011
        read_path(file)
    assert str(caught.value).startswith(f"{file}: ")
    assert message in str(caught.value)


@pytest.mark.parametrize("mark", [";", "\t"])
def test_semicolons_tabs_and_decimal_commas_are_read(tmp_path: Path, mark: str) -> None:
    file = tmp_path / "a.csv"
    rows = ["x [mm]; y [mm]", "1,5;2", "", "3.5;-4,25e1", ""]
    file.write_text("\n".join(rows).replace(";", mark))
    assert read_path(file).points == pytest.approx(np.array([[1.5, 2], [3.5, -42.5]]) / 1e3)


def test_what_is_no_text_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_bytes(b"\x89PNG\xff\xfe")
    with pytest.raises(ValueError, match=r"a\.csv: is no text in UTF-8 \(line 1, byte 0x89\)"):
        read_path(file)


def test_a_trace_is_in_metres(tmp_path: Path) -> None:
    device = ebac.presets.device("joystick")
    scenario = ebac.Scenario(device=device, environment=ebac.Free(), seconds=0.05)
    file = tmp_path / "a.npz"
    ebac.simulate(scenario, "direct").to_npz(file)
    assert read_path(file, unit="m").points.shape[1] == 2
    with pytest.raises(ValueError, match="unit = 'mm': a trace is in m"):
        read_path(file, unit="mm")


@pytest.mark.parametrize("shape", FITS)
def test_auto_finds_what_was_followed(tmp_path: Path, shape: str) -> None:
    path = read_path(write(tmp_path / "a.csv", "x [m],y [m]", noisy(shape, 5)))
    assert evaluate(path).shape == shape
    assert isinstance(evaluate(path).fit, LineFit if shape == "line" else CircleFit)


# --- the simulated joystick ---


def test_a_joystick_without_errors_is_the_gimbal_of_the_core() -> None:
    device = ebac.presets.device("joystick")
    none = ErrorSources(encoder=False, zero=0, skew=0, axis_offset=0, lever=0, ratio=0, slack=0)
    perfect = Joystick.draw(device, none, np.random.default_rng(1))
    x = np.random.default_rng(2).uniform(-0.045, 0.045, (50, 2))
    q = nominal_joints(x, 0.1)
    gimbal = ebac.Gimbal()
    for row, angle in zip(x, q, strict=True):
        assert np.asarray(gimbal.forward(angle))[:2] == pytest.approx(row, abs=1e-12)
    assert perfect.handle(q)[:, :2] == pytest.approx(x, abs=1e-12)
    assert perfect.shown(x) == pytest.approx(x, abs=1e-12)


@given(seed=seeds)
@settings(max_examples=20)
def test_the_joints_of_a_crooked_joystick_bring_its_handle_there(seed: int) -> None:
    crooked = Joystick.draw(
        ebac.presets.device("joystick"),
        ErrorSources(skew=0.05, axis_offset=3e-3, lever=3e-3),
        np.random.default_rng(seed),
    )
    x = np.random.default_rng(seed).uniform(-0.04, 0.04, (20, 2))
    assert crooked.handle(crooked.joints(x))[:, :2] == pytest.approx(x, abs=1e-11)


def test_counts_alone_are_what_the_simulated_device_shows() -> None:
    """The same circle through the core's joystick: encoder, kinematics and all, led by a stiff hand."""
    t = np.linspace(0, 4, 401)
    ways = [ebac.Recorded(t=t.tolist(), x=(0.03 * f(1.5 * t)).tolist()) for f in (np.sin, np.cos)]
    device = ebac.presets.device("joystick")
    scenario = ebac.Scenario(
        device=device,
        hand=ebac.Hand(mass=0.5, damping=100, stiffness=5000, path=ways),
        environment=ebac.Free(),
        seconds=4.0,
    )
    trace = ebac.simulate(scenario, "direct")[1.0:]
    shown, true = trace["x"], trace["true.x"]
    error = shown - true
    count = device.count
    assert np.abs(error).max() < 1.5 * count
    sd = error.std(axis=0).mean()  # where zero lies within a count is chance
    assert sd == pytest.approx(count / math.sqrt(12), rel=0.15)
    stick = Joystick.draw(device, ErrorSources().only("encoder"), np.random.default_rng(1))
    assert (stick.shown(true) - true).std(axis=0).mean() == pytest.approx(sd, rel=0.15)


@given(play=st.floats(1e-5, 5e-3), seed=seeds)
@settings(max_examples=15)
def test_slack_moves_a_position_by_no_more_than_half_of_it(play: float, seed: int) -> None:
    stick = Joystick.draw(
        ebac.presets.device("joystick"),
        ErrorSources(slack=play).only("cable slack"),
        np.random.default_rng(seed),
    )
    turn = np.linspace(0, 7, 300)
    x = 0.03 * np.column_stack([np.cos(turn), np.sin(turn)])
    off = np.abs(stick.shown(x) - x)
    assert (
        off.max() <= 0.5 * 1.5 * play * 1.25
    )  # half of the play drawn, and the slope of the sphere
    assert off.max() > 0.2 * play


@pytest.mark.slow
def test_the_budget_adds_up_and_blames_what_it_should() -> None:
    budget = error_budget(runs=5, seed=3)
    count = ebac.presets.device("joystick").count
    for shape in ("line", "circle"):
        encoder, every = budget.row(shape, "encoder"), budget.row(shape, "all")
        assert encoder.sd_m == pytest.approx(count / math.sqrt(12), rel=0.2)
        assert every.sd_m > budget.row(shape, "cable slack").sd_m * 0.8
        assert every.sd_low_m <= every.sd_m <= every.sd_high_m
        assert budget.unexplained_m(shape) > 0
    assert budget.row("line", "all").radius_m is None
    assert error_budget(runs=5, seed=3).rows == budget.rows
    assert error_budget(runs=5, seed=4).rows != budget.rows


@pytest.mark.slow
def test_the_slack_that_would_explain_the_table_does() -> None:
    slack = error_budget(runs=4, seed=3).slack_m["circle"]
    assert slack is not None
    sd = error_budget(sources=ErrorSources(slack=slack), runs=4, seed=3).row("circle", "all").sd_m
    assert sd == pytest.approx(np.mean([e.sd_m for e in TABLE_I if e.shape == "circle"]), rel=0.01)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ErrorSources(slack=-1), r"ErrorSources.slack = -1 m: must lie in \[0, 0.02\] m"),
        (lambda: ErrorSources(skew=math.nan), "ErrorSources.skew = nan rad"),
        (lambda: error_budget(runs=1), "runs = 1: must lie in"),
        (lambda: error_budget(radius=0.08), r"radius = 0.08 m: must lie in \(0, 0.049\] m"),
        (lambda: error_budget(device=ebac.Device()), "needs a Gimbal"),
    ],
)
def test_a_budget_that_cannot_be_is_refused(call: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()


def test_masked_points_are_refused() -> None:
    """Their values were counted all the same."""
    points = np.ma.masked_greater(np.array([[0.0, 1], [1, 0], [0, -1], [-1, 0], [5, 5]]), 2)
    with pytest.raises(ValueError, match="points: some are masked"):
        fit_circle(points)
