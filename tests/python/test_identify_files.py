"""Files that are no recording: each gets one sentence that names it, what is wrong and what to do."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.identify import Target, fit_arm, fit_device, load
from ebac.tracking import read_path

ROWS = 200
T = 1e-3 * np.arange(ROWS)
X = 3e-5 * np.round(1e3 * np.sin(20 * T))
F = np.cos(20 * T)


def text(head: str, *columns: np.ndarray, mark: str = ",") -> bytes:
    rows = [mark.join(f"{value:.6g}" for value in row) for row in zip(*columns, strict=True)]
    return "\n".join([head, *rows, ""]).encode()


HOLE = np.where(np.arange(ROWS) == 100, np.nan, X)
NOISE = np.random.default_rng(1).bytes(3000)
BAD: dict[str, tuple[bytes, str]] = {
    "no_position.csv": (text("t,force", T, F), "found no position among t, force"),
    "no_time.csv": (
        text("x,force", X, F),
        "found no time among x, force; say how many rows a second",
    ),
    "hole.csv": (
        text("t,x,force", T, HOLE, F),
        "x is no number in 1 of 200 rows, first in row 101",
    ),
    "still.csv": (text("t,x,force", T, 0 * T, F), "x is constant at 0 m"),
    "same_force.csv": (text("t,x,force", T, X, 0 * T + 1), "force is constant at 1 N"),
    "unknown.csv": (text("t,x [furlong],force", T, X, F), "must be one of m, mm, cm"),
    "large.csv": (text("t,x,force", T, 1e3 * X, F), "x spans .* a hand 2.5 m at most.*--unit x=mm"),
    "small.csv": (text("t,x [um],force", T, X, F), "less than a hand that holds still.*--unit x=m"),
    "slow.csv": (text("t,x,force", 1e3 * T, X, F), "rows are 1 s apart.*--unit t=ms"),
    "backwards.csv": (text("t,x,force", T[::-1], X, F), "t goes back in row 2; sort the log"),
    "repeated.csv": (
        text("t,x,force", np.repeat(T[::2], 2), X, F),
        "t is that of the row before in 100 rows, first in row 2; give the rows a second .*--rate",
    ),
    "three.csv": (text("t,x,force", T[:3], X[:3], F[:3]), "3 rows; needs at least 50"),
    "empty.csv": (b"", "is empty: needs a heading"),
    "heading.csv": (b"t,x,force\n", "no rows below its heading"),
    "words.csv": (b"t,x,force\n0,left,1\n1,2,1\n", "'left' in row 1, column 'x', is no number"),
    "ragged.csv": (
        b"t,x,force\n0,1,1\n1,2\n",
        "row 2 below the heading has 2 cells, the heading 3; complete that line, or delete it",
    ),
    "twice.csv": (
        text("t,x,force,x", T, X, F, 0 * X),
        "columns 2 and 4 are both headed 'x'; rename one of them",
    ),
    "text_twice.csv": (
        b"t,x,x\n0,1,left\n1,2,right\n",
        "columns 2 and 3 are both headed 'x'; rename one of them",
    ),
    "binary.csv": (NOISE, "is no text in UTF-8"),
    "binary.npz": (NOISE, "is no NumPy archive"),
    "empty.npz": (b"", "is no NumPy archive"),
    "binary.mat": (NOISE, "cannot be read"),
    "empty.mat": (b"", "cannot be read"),
    "binary.mcap": (NOISE, "not an MCAP file"),
    "empty.mcap": (b"", "0 bytes"),
    "sheet.xlsx": (b"PK", "unknown ending '.xlsx'; known are .mcap, .csv"),
}
by_file = pytest.mark.parametrize("name", BAD)


@pytest.fixture
def bad(tmp_path: Path) -> Callable[[str], Path]:
    def write(name: str) -> Path:
        (tmp_path / name).write_bytes(BAD[name][0])
        return tmp_path / name

    return write


@by_file
def test_what_is_no_recording_is_refused_with_a_reason(
    name: str, bad: Callable[[str], Path]
) -> None:
    if name.endswith(".mat"):
        pytest.importorskip("scipy")
    with pytest.raises(ValueError, match=rf"(?s){name}.*{BAD[name][1]}"):
        load(bad(name))


@by_file
@pytest.mark.parametrize("command", ["arm", "device", "gains", "log"])
def test_a_command_says_it_in_one_line(command: str, name: str, bad: Callable[[str], Path]) -> None:
    result = CliRunner().invoke(app, ["identify", command, str(bad(name))])
    assert result.exit_code == 2
    told = [line for line in result.stderr.splitlines() if line.strip()]
    assert len(told) == 1, result.stderr
    assert told[0].startswith("Error: ")
    assert name in told[0]


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ({"count": 1.0}, r"count = 1 m: x spans .* less than one count"),
        ({"rate": 1.0}, r"rate = 1 Hz: rows are then 1 s apart"),
        ({"lever": 0.1}, r"lever = 0\.1: the file has no angle or torque; leave it out"),
    ],
)
def test_an_option_that_no_hand_fits_is_named(
    options: dict[str, Any], why: str, tmp_path: Path
) -> None:
    (tmp_path / "log.csv").write_bytes(text("t,x,force", T, X, F))
    with pytest.raises(ValueError, match=why):
        load(tmp_path / "log.csv", **options)


def test_a_log_of_another_format_is_turned_by_export(tmp_path: Path) -> None:
    (tmp_path / "log.h5").touch()
    with pytest.raises(ValueError, match=r"ebac log export log\.h5 log\.csv"):
        load(tmp_path / "log.h5")


@pytest.mark.parametrize("unit", ["in", "inch"])
def test_inches_are_a_unit(unit: str, tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_bytes(text(f"t,x [{unit}],force", T, X / 0.0254, F))
    assert load(tmp_path / "log.csv").x == pytest.approx(X, abs=1e-6)


def test_a_folder_is_no_recording(tmp_path: Path) -> None:
    with pytest.raises(IsADirectoryError, match="is a folder"):
        load(tmp_path)


@pytest.mark.parametrize(
    ("name", "content", "why"),
    [
        ("empty.csv", b"", "needs a heading and rows below it"),
        ("empty.npz", b"", "not a trace written by to_npz"),
        ("binary.npz", NOISE, r"not a trace written by to_npz \(no archive\)"),
        ("binary.csv", NOISE, "is no text"),
        ("far.csv", text("x [furlong],y [furlong]", T, T), "'furlong': must be one of m, mm"),
        ("both.csv", text("x [mm],y [m]", T, T), "have several units"),
        ("hole.csv", text("x,y", HOLE, T), "row 101: nan is not finite"),
    ],
)
def test_what_is_no_path_is_refused_with_a_reason(
    name: str, content: bytes, why: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=why):
        read_path(tmp_path / name)
    result = CliRunner().invoke(app, ["track", str(tmp_path / name)])
    assert result.exit_code == 2


def test_columns_without_a_heading_are_no_doubles(tmp_path: Path) -> None:
    nothing = np.full(ROWS, np.nan)
    path = tmp_path / "spreadsheet.csv"
    path.write_bytes(text("t,x,force,,", T, X, F, nothing, nothing).replace(b"nan", b""))
    np.testing.assert_allclose(load(path).x, X, atol=1e-9)


def test_decimal_commas_are_read(tmp_path: Path) -> None:
    plain, german = tmp_path / "plain.csv", tmp_path / "german.csv"
    plain.write_bytes(text("t,x [mm],force", T, 1e3 * X, F))
    german.write_bytes(text("t;x [mm];force", T, 1e3 * X, F, mark=";").replace(b".", b","))
    a, b = load(plain), load(german)
    assert (a.x == b.x).all()
    assert (a.force == b.force).all()


@pytest.mark.slow
@pytest.mark.weekly
def test_a_wall_that_pushes_unrecorded_is_no_device(tmp_path: Path) -> None:
    """The hand's force alone, while a law pushed: nothing is determined, and nothing runs away."""
    hand = ebac.Hand(path=[ebac.Tapping()])
    trace = ebac.simulate(ebac.Scenario(hand=hand, seconds=3), "ebac")
    columns = (np.array(trace[name]) for name in ("t", "x", "f_meas"))
    (tmp_path / "hand.csv").write_bytes(text("t,x,force", *columns))
    r = load(tmp_path / "hand.csv")
    assert fit_arm(r, Target.tapping(1.5, r.seconds)).undetermined == ()
    assert fit_device(r).explained < 0.9


TEXT = {
    "words": lambda i: "hold",
    "empty": lambda i: "start" if i == 0 else "",
    "numbers among them": lambda i: str(i) if i % 7 == 0 else "hold",
    "a separator in quotes": lambda i: '"held, then let go"',
}


@pytest.mark.parametrize("kind", TEXT)
def test_columns_of_text_are_left_out_with_a_note(tmp_path: Path, kind: str) -> None:
    signals = enumerate(zip(T, X, F, strict=True))
    rows = [f"{t:.6g},{TEXT[kind](i)},{x:.6g},{f:.6g}" for i, (t, x, f) in signals]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(["t,comment,x,force", *rows, ""]))
    found = load(path)
    assert found.x == pytest.approx(X, abs=1e-9)
    assert "column 'comment' is left out: it contains text" in found.remarks
    with pytest.raises(ValueError, match=r"in row \d, column 'comment', is no number"):
        load(path, columns={"force": "comment"})


def test_a_unit_that_its_heading_contradicts_is_reported(tmp_path: Path) -> None:
    signals = zip(T, X, F, strict=True)
    path = tmp_path / "log.csv"
    rows = (f"{t:.6g},{1e3 * x:.6g},{f:.6g}" for t, x, f in signals)
    path.write_text("\n".join(["t,x [m],force", *rows, ""]))
    told = "x: taken as mm as asked, column 'x [m]' says m"
    assert told in load(path, units={"x": "mm"}).remarks
    path.write_text(path.read_text().replace("x [m]", "x [mm]"))
    assert not any("as asked" in remark for remark in load(path, units={"x": "mm"}).remarks)


def test_a_rate_that_the_time_contradicts_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    signals = zip(T, X, F, strict=True)
    rows = (f"{t:.6g},{x:.9g},{f:.6g}" for t, x, f in signals)
    path.write_text("\n".join(["t,x,force", *rows, ""]))
    own = 1 / (T[1] - T[0])
    told = f"column 't', which says {own:.4g} rows a second, is not used"
    assert any(told in remark for remark in load(path, rate=own / 10).remarks)
    assert not any("which says" in remark for remark in load(path, rate=own).remarks)


@pytest.mark.parametrize("by_row", [False, True])
def test_a_struct_of_matlab_is_a_table(tmp_path: Path, by_row: bool) -> None:
    scipy_io = pytest.importorskip("scipy.io")
    columns = {"t": T, "x": X, "force": F}
    log: object = {**columns, "who": "a hand"}
    if by_row:
        log = np.zeros(ROWS, dtype=[(name, object) for name in (*columns, "who")])
        for name, values in columns.items():
            log[name] = values
        log["who"] = "a hand"
    scipy_io.savemat(tmp_path / "log.mat", {"log": log})
    found = load(tmp_path / "log.mat")
    assert found.force is not None
    assert found.force == pytest.approx(F)
    assert found.x == pytest.approx(X)


def test_signals_of_simulink_are_read_by_their_labels(tmp_path: Path) -> None:
    """A structure with time: an array of structs, each with all values of one signal."""
    scipy_io = pytest.importorskip("scipy.io")
    signals = np.zeros((1, 2), dtype=[(name, object) for name in ("values", "label", "dimensions")])
    signals[0, 0] = (np.rad2deg(X)[:, None], "theta [deg]", 1)
    signals[0, 1] = (1e3 * F[:, None], "torque [mN*m]", 1)
    log = {"time": T[:, None], "signals": signals, "blockName": "knob/scope"}
    scipy_io.savemat(tmp_path / "log.mat", {"log": log})
    found = load(tmp_path / "log.mat")
    assert found.units == ("rad", "N m")
    assert found.x == pytest.approx(X)
    assert found.force == pytest.approx(F)


def test_trials_in_an_array_of_structs_are_columns(tmp_path: Path) -> None:
    scipy_io = pytest.importorskip("scipy.io")
    trials = np.zeros((1, 3), dtype=[(name, object) for name in ("t", "x", "force", "who")])
    for i in range(3):
        trials[0, i] = (T, (i + 1) * X, F, "a hand")
    scipy_io.savemat(tmp_path / "log.mat", {"trials": trials})
    columns = {"t": "trials_2_t", "x": "trials_2_x", "force": "trials_2_force"}
    assert load(tmp_path / "log.mat", columns=columns).x == pytest.approx(2 * X)
    with pytest.raises(ValueError, match="no force of the hand among trials_1_t, trials_1_x"):
        load(tmp_path / "log.mat")


# --- which column is the position ---


@pytest.mark.parametrize(
    "heading",
    [
        "pos",
        "Pos [mm]",
        "handle pos",
        "Handle Pos [mm]",
        "handle_pos",
        "Handle Position (mm)",
        "pos_x",
    ],
)
def test_usual_names_of_a_position_are_read(heading: str, tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_bytes(text(f"Time [s],{heading},Force [N]", T, 1e3 * X, F))
    found = load(tmp_path / "log.csv", units={"x": "mm"})
    assert found.x == pytest.approx(X, rel=1e-4, abs=1e-9)
    assert found.force is not None


@pytest.mark.parametrize(
    "heading",
    [
        "Target Pos [mm]",
        "pos_error",
        "Desired Position [mm]",
        "Motor Pos [mm]",
        "pose",
        "handle force",
    ],
)
def test_nothing_else_is_read_as_a_position(heading: str, tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_bytes(text(f"t,{heading},Fz", T, 1e3 * X, F))
    with pytest.raises(ValueError, match="found no position among"):
        load(tmp_path / "log.csv")


def test_other_positions_do_not_take_the_place_of_the_handle(tmp_path: Path) -> None:
    head = "t,Target Pos [m],Motor Pos [m],Handle Pos [m],force"
    (tmp_path / "log.csv").write_bytes(text(head, T, 5 * X, 3 * X, X, F))
    found = load(tmp_path / "log.csv")
    assert found.x == pytest.approx(X, rel=1e-4, abs=1e-9)
    assert found.target is None


def test_a_column_of_decimal_commas_is_named(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text('t [s],x [mm],force [N]\n0,"1,5",2\n0.001,"1,6",2\n')
    with pytest.raises(ValueError, match=r"'1,5' in row 1, column 'x \[mm\]', .*; write 1\.5"):
        load(tmp_path / "log.csv")
