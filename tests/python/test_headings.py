"""Headings with units: every usual form, and every reader alike."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest

import ebac
from ebac import logs
from ebac._util.headings import FACTORS, signal_heading, split_heading, with_units
from ebac.identify import load
from ebac.tracking import read_path

FORMS = (
    "{} [{}]",
    "{}[{}]",
    "{} ({})",
    "{}({})",
    "{}_{}",
    "{} {}",
    "{}.{}",
    "{}/{}",
    "  {} [ {} ] ",
)


@pytest.mark.parametrize("quantity", FACTORS)
def test_every_form_of_every_unit(quantity: str) -> None:
    for form, unit in product(FORMS, FACTORS[quantity]):
        assert split_heading(form.format("f_meas", unit), FACTORS[quantity]) == (
            "f_meas",
            unit.replace("\u00b5", "u"),
        )


@pytest.mark.parametrize("heading", ["x", "x_0", "f_m", "mm", "_mm", "force_x", "[mm]"])
def test_a_name_without_unit_stays_whole(heading: str) -> None:
    assert split_heading(heading, FACTORS["force"]) == (heading, None)


def test_the_greek_letter_is_the_micro_sign() -> None:
    for sign in ("\u03bc", "\u00b5", "u"):
        assert split_heading(f"x [{sign}m]", ()) == ("x", "um")
        assert split_heading(f"x_{sign}m", FACTORS["length"]) == ("x", "um")


@pytest.mark.parametrize("form", ["{} [{}]", "{} ({})", "{}_{}", "{}.{}"])
def test_the_letters_of_a_unit_may_be_capital(form: str) -> None:
    assert split_heading(form.format("X", "MM"), FACTORS["length"]) == ("X", "mm")
    assert split_heading(form.format("T", "MS"), FACTORS["time"]) == ("T", "ms")
    assert split_heading("F [MN]", FACTORS["force"]) == (
        "F",
        "MN",
    )  # a meganewton is no millinewton


@pytest.mark.parametrize("prefix", ["", "m", "k"])
def test_a_torque_in_any_spelling(prefix: str) -> None:
    forms = ("{} [{}]", "{} ({})", "{}_{}", "{} {}", "{}/{}", "{}.{}")
    marks = ("", " ", "*", ".", "-", "_", "\u00b7", "\u22c5")
    factor = FACTORS["torque"][f"{prefix}N m"]
    for form, mark in product(forms, marks):
        heading = form.format("tau", f"{prefix}N{mark}m")
        assert split_heading(heading, FACTORS["torque"]) == ("tau", f"{prefix}N m")
        assert signal_heading(heading) == ("tau", "N m", factor)


def test_letters_that_look_like_a_torque() -> None:
    assert split_heading("tau [MNm]", FACTORS["torque"]) == ("tau", "MNm")  # a mega, no milli
    assert split_heading("torque_nm", FACTORS["torque"]) == ("torque", "N m")
    assert signal_heading("x [nm]") == ("x", "nm", 1.0)  # a nanometre, no newton metre
    assert split_heading("f_n_m", FACTORS["torque"]) == ("f_n_m", None)


@pytest.mark.parametrize(
    ("heading", "meant"),
    [
        ("x_mm", ("x", "m", 1e-3)),
        ("X [MM]", ("x", "m", 1e-3)),
        ("x", ("x", "m", 1.0)),
        ("time (ms)", ("t", "s", 1e-3)),
        ("Zeit [ms]", ("t", "s", 1e-3)),
        ("f_meas.N", ("f_meas", "N", 1.0)),
        ("true.x_0 [m]", ("true.x_0", "m", 1.0)),
        ("law.f_d", ("law.f_d", "1", 1.0)),
        ("x_min", ("x_min", "1", 1.0)),
        ("current [A]", ("current", "A", 1.0)),
        ("theta_deg", ("theta", "rad", np.pi / 180)),
        ("x [°]", ("x", "rad", np.pi / 180)),
        ("motor_mNm", ("motor", "N m", 1e-3)),
        ("angle", ("angle", "rad", 1.0)),
        ("tau_0", ("tau_0", "N m", 1.0)),
    ],
)
def test_headings_of_a_log(heading: str, meant: tuple[str, str, float]) -> None:
    assert signal_heading(heading) == meant


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "# by us\nx [mm],y [mm]\n1,2\n",
            "line 2 has the headings of a path.*`ebac track log.csv`",
        ),
        ("m_kg,b_Ns_per_m\n1,2\n", "headings of hands.*`ebac study --population log.csv`"),
        ("x [m]\n1\n", r"line 1 has no column of time, `t \[s\]`.*--rate"),
        ("t,x,X\n1,2,3\n", "line 1 has column 'x' more than once"),
        ("t,x\n1,2\n2,abc\n", "line 3, column 'x': 'abc' is no number"),
        ("t,x\n1,2\n2\n", "line 3 has 1 cells for 2 headings"),
        ("", "the file is empty"),
    ],
)
def test_what_is_no_log_is_refused_with_the_command_that_reads_it(
    text: str, message: str, tmp_path: Path
) -> None:
    file = tmp_path / "log.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=message) as refused:
        logs.load(file)
    assert str(refused.value).startswith(f"{file}: ")


def test_a_log_may_have_other_units_and_separators(tmp_path: Path) -> None:
    file = tmp_path / "log.csv"
    file.write_text("Time [ms];X_mm;force\n0;1;2\n0.5;2;3\n", encoding="utf-8-sig")
    trace = logs.load(file)
    assert {name: c.unit for name, c in trace.columns.items()} == {"t": "s", "x": "m", "force": "N"}
    np.testing.assert_allclose(trace["t"], [0, 5e-4])
    np.testing.assert_allclose(trace["x"], [1e-3, 2e-3])


def table(path: Path, headings: list[str], columns: np.ndarray) -> Path:
    np.savetxt(path, columns.T, delimiter=",", header=",".join(headings), comments="")
    return path


@pytest.mark.parametrize("form", FORMS[:8])
def test_readers_agree(form: str, tmp_path: Path) -> None:
    t = np.arange(100.0)
    x, y = 40 * np.sin(t / 9), 40 * np.cos(t / 9)
    heads = [
        form.format(*pair) for pair in (("t", "ms"), ("x", "mm"), ("y", "mm"), ("force", "mN"))
    ]
    file = table(tmp_path / "log.csv", heads, np.array([t, x, y, 1e3 * x]))
    r = load(file)
    assert r.dt == pytest.approx(1e-3)
    np.testing.assert_allclose(r.x, 1e-3 * x)
    np.testing.assert_allclose(r.force, x)
    np.testing.assert_allclose(read_path(file).points, 1e-3 * np.array([x, y]).T)
    heads = [
        form.format(*p) for p in (("m", "kg"), ("B0", "N s/m"), ("k", "N/mm"), ("target", "mm"))
    ]
    file = table(tmp_path / "hands.csv", heads, np.array([[0.3], [7.0], [0.4], [25.0]]))
    hand = ebac.Operators.from_csv(file)
    assert hand.k_N_per_m.tolist() == [400.0]
    assert hand.target_m.tolist() == [0.025]
    assert hand.b_Ns_per_m.tolist() == [7.0]


def test_tremor_has_two_columns_by_their_units(tmp_path: Path) -> None:
    heads = ["m_kg", "b_Ns_per_m", "k_N_per_m", "target_m", "tremor [mm]", "tremor (Hz)"]
    file = table(tmp_path / "hands.csv", heads, np.array([[0.3], [7], [400], [0.02], [0.5], [8]]))
    hand = ebac.Operators.from_csv(file)
    assert (hand.tremor_m[0], hand.tremor_Hz[0]) == (0.0005, 8.0)


def test_a_trace_with_round_brackets_is_a_trace(tmp_path: Path) -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.05), "tca")
    trace.to_csv(tmp_path / "run.csv")
    text = (tmp_path / "run.csv").read_text(encoding="utf-8")
    head, _, rows = text.partition("\n")
    (tmp_path / "round.csv").write_text(
        head.replace("[", "(").replace("]", ")") + "\n" + rows, encoding="utf-8"
    )
    other = logs.load(tmp_path / "round.csv")
    assert other.columns["x"].unit == "m"
    np.testing.assert_array_equal(other["x"], trace["x"])


def test_units_stand_in_the_keys_of_json() -> None:
    found = with_units({"impulse": 2.0, "force": 1.0, "count": 3}, {"impulse": "N s", "force": "N"})
    assert found == {"impulse_N_s": 2.0, "force_N": 1.0, "count": 3}
