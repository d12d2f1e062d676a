"""Ablation: pieces are discovered, each is off in its own row, and what differs is told."""

import csv
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac import Ablation, Operators, Variant, ablation
from ebac.cli import app
from ebac.laws import changed, law_name
from ebac.studies import MEASURES, pieces
from ebac.studies.ablation import GAINS

FEW = Operators.grid(mass=[0.15], damping=[2, 6], stiffness=[300], target=[0.04])  # 2 hands
KEYS = [
    "law", "piece", "changes", "hands", "good", "exact_and_still", "settled_in_time", "median_settled_s", "good_K20",
    "good_d2_K20", "good_slow_press_d2_K20", "good_tremor", "least_energy_impact_J", "least_energy_let_go_J",
    "least_energy_pumping_J", "force_swing_N", "force_swing_noise_N", "force_step_N", "friction_m", "worse", "better",
]  # fmt: skip

#: On the encoder alone, and without a piece.
ENCODER = [{"observer": False, "recovery": False}, {"observer": False, "guard": False}]


@pytest.fixture(scope="module")
def few() -> Ablation:
    return ablation(FEW, changes=ENCODER)


# --- a law with parameters changed ---


def test_a_variant_is_designed_anew_with_its_changes_on_top() -> None:
    law = Variant("ebac", {"kp": 0.0, "guard": False})
    assert law.name == "ebac, kp = 0, guard = off"
    for delay in (0, 2):
        timing = ebac.Timing(delay=delay)
        made = ebac.design(law, ebac.Device(), timing)
        assert made == ebac.design("ebac", ebac.Device(), timing, kp=0.0, guard=False)
    assert ebac.design(law, ebac.Device(), timing, kp=0.2).as_dict()["kp"] == 0.2  # type: ignore[union-attr]
    assert changed(law, kp=0.3) == Variant("ebac", {"kp": 0.3, "guard": False})


class OwnLaw:
    REFUSED = (
        r"^ebac.Variant takes a law of ebac.LAWS or its class; make a law of your own with other arguments, "
        r"OwnLaw\(damping=...\)$"
    )

    def step(self, port: ebac.Port) -> float:
        return port.f_env

    def reset(self) -> None: ...


@pytest.mark.parametrize(
    ("law", "changes", "kind", "message"),
    [
        ("ebac", {"kp": 3.0}, ValueError, r"EBAC.kp = 3: must lie in \[0, 0.5\]"),
        ("ebac", {"kpp": 0.2}, TypeError, "EBAC has no parameter 'kpp', did you mean 'kp'; it has"),
        ("ebac", {"timing": 1}, TypeError, "EBAC has no parameter 'timing'"),
        ("ebac", {"guard": 2.0}, TypeError, "EBAC.guard = 2.0: must be bool"),
        ("tca-damped-tuned", {"kpp": 0.2}, TypeError, "TCADamped has no parameter 'kpp'"),
        (ebac.EBA, {"kp": 0.2}, TypeError, "EBA has no parameter 'kp'"),
        ("ebak", {}, KeyError, "no law is called 'ebak', did you mean"),
        (int, {}, TypeError, r"int is a class: give an instance of it, int\(...\)"),
        (ebac.EBA(), {}, TypeError, "^ebac.Variant takes a law of ebac.LAWS or its class, not EBA"),
        (3, {}, TypeError, r"^ebac.Variant takes a law of ebac.LAWS or its class, not 3 \(int\)$"),
        (OwnLaw, {"damping": 2.0}, TypeError, OwnLaw.REFUSED),
        (OwnLaw(), {"damping": 2.0}, TypeError, OwnLaw.REFUSED),
        ("ebac", 3, TypeError, "^ebac.Variant takes changes by name, as in {'kp': 0.2}, not 3"),
    ],
)
def test_a_variant_that_cannot_be_is_refused_when_it_is_made(
    law: Any, changes: Any, kind: type[Exception], message: str
) -> None:
    with pytest.raises(kind, match=message):
        Variant(law, changes)


def test_a_variant_of_tuned_parameters_keeps_the_others() -> None:
    law = Variant("tca-damped-tuned", {"kp": 0.1})
    made: Any = ebac.design(law, ebac.Device(), ebac.Timing())
    tuned: Any = ebac.design("tca-damped-tuned", ebac.Device(), ebac.Timing())
    assert made == tuned.replace(kp=0.1)


def test_a_variant_runs_wherever_a_law_does() -> None:
    scenario = ebac.Scenario(seconds=0.3)
    alone = ebac.simulate(scenario, "ebac", injection=False)
    variant = Variant("ebac", {"injection": False})
    again = ebac.simulate(scenario, variant)
    assert alone["f_cmd"].tobytes() == again["f_cmd"].tobytes()
    swept = ebac.sweep([scenario], ["ebac", variant])
    assert swept["law"].tolist() == ["ebac", "ebac, injection = off"]
    assert swept["rest_m"][1] == ebac.contact(alone).rest_m


# --- pieces ---


@pytest.mark.parametrize("name", [n for n, law in ebac.LAWS.items() if hasattr(law, "kp")])
def test_the_pieces_are_those_of_the_field_list(name: str) -> None:
    law = ebac.LAWS[name]
    booleans = {f.name for f in law.fields() if f.kind == "bool"}
    found = pieces(name)
    gains = {gain for gain in GAINS if hasattr(law, gain)}
    assert {piece.name for piece in found} == booleans | gains
    for piece in found:
        [(field, value)] = piece.changes.items()
        designed: Any = ebac.design(name, ebac.Device(), ebac.Timing())
        assert getattr(designed, field) != value
        assert piece.meaning


@dataclass(frozen=True)
class Own:
    """A law of a user's: the world's force, damped when told."""

    damped: bool = True
    name = "own"

    def reset(self) -> None: ...

    def step(self, port: ebac.Port) -> float:
        return port.f_env + (30.0 * port.v if self.damped and port.f_env > 0 else 0.0)


def test_a_law_of_ones_own_has_its_pieces_taken_too() -> None:
    assert [piece.label for piece in pieces(Own())] == ["damped off"]
    assert changed(Own(), damped=False) == Own(damped=False)
    finished = ebac.EBAC(kp=0.0)
    assert changed(finished, guard=False) == finished.replace(guard=False)
    assert "kp = 0" not in [piece.label for piece in pieces(finished)]  # is zero as it is
    one = Operators.grid(mass=[0.5], damping=[6], stiffness=[300], target=[0.04])
    quick = ebac.Scenario(seconds=0.2)
    found = ablation(one, Own(), beside=(), base=quick, measures=MEASURES[:2])
    assert [row.label for row in found.rows] == ["own", "damped off"]
    assert list(found.rows[0].values) == ["good", "exact_and_still"]
    assert [c.name for c in found.study.conditions] == ["d1K10"]


def test_what_cannot_be_taken_apart_is_refused() -> None:
    class Bare:
        name = "bare"

        def reset(self) -> None: ...

        def step(self, port: ebac.Port) -> float:
            return port.f_env

    with pytest.raises(ValueError, match="direct has no boolean parameter and none of kp"):
        ablation(FEW, "direct")
    with pytest.raises(ValueError, match="bare has no boolean"):
        ablation(FEW, Bare())
    with pytest.raises(TypeError, match="fields of a dataclass"):
        changed(Bare(), damped=False)
    with pytest.raises(ValueError, match=r"EBAC.pull = -1 N: must lie in"):
        ablation(FEW, changes=[{"pull": -1.0}])
    assert law_name(Bare()) == "bare"


# --- rows ---


@pytest.mark.slow
@pytest.mark.weekly
def test_a_row_for_the_law_each_piece_and_each_law_beside(few: Ablation) -> None:
    labels = [row.label for row in few.rows]
    expected = [piece.label for piece in pieces("ebac", ENCODER)]
    assert labels == ["ebac", *expected, "tca", "eba"]
    assert list(few.rows[0].row()) == KEYS
    assert all(row.hands == 2 for row in few.rows)
    assert few.rows[0].worse == few.rows[0].better == ()
    assert few.rows[0].earns is None


@pytest.mark.slow
@pytest.mark.weekly
def test_a_measure_is_what_a_study_says(few: Ablation) -> None:
    named = {(row.law, row.condition): row for row in few.study.rows}
    for row in (few.rows[0], few.rows[-1]):
        plain = named[row.law, "d1K10"]
        assert row.values["good"] == plain.good
        assert row.values["settled_in_time"] == plain.settled_in_time
        assert row.values["good_K20"] == named[row.law, "d1K20"].good
        assert row.values["least_energy_pumping_J"] == named[row.law, "pumping"].least_energy_J
        least = min(
            named[row.law, name].least_energy_J or 0.0 for name in ("d1K10", "d1K20", "d2K20")
        )
        assert row.values["least_energy_impact_J"] == least


def test_the_force_step_is_the_largest_inside_of_the_wall_over_all_hands(few: Ablation) -> None:
    for row, law in ((few.rows[0], "ebac"), (few.rows[-1], "eba")):
        steps = []
        for scenario in FEW.scenarios(ebac.Scenario()):
            trace = ebac.simulate(scenario.replace(seed=few.study.scenarios[len(steps)].seed), law)
            asked = trace["f_env"] != 0
            steps += [float(np.abs(np.diff(trace["f_cmd"]))[asked[1:] & asked[:-1]].max())]
        assert row.values["force_step_N"] == max(steps)
        # The step at the surface is not among them.
        assert max(steps) < few.study.columns["force_step_N"][few.study.runs("ebac", "d1K10")].max()


def test_what_the_law_needs_is_worse_without_it(few: Ablation) -> None:
    rows = {row.label: row for row in few.rows}
    for off in ("observer off", "observer off, recovery off"):
        assert "good" in rows[off].worse
    assert "good_d2_K20" in rows["injection off"].worse
    assert "exact_and_still" in rows["observer off, recovery off"].worse
    assert "exact_and_still" not in rows["observer off"].worse
    assert not rows["recovery off"].worse  # with the observer nothing is left to recover
    assert "least_energy_pumping_J" in rows["observer off"].worse
    worse = rows["observer off, guard off"].values["least_energy_pumping_J"]
    assert worse is not None
    assert worse < 10 * (rows["observer off"].values["least_energy_pumping_J"] or 0)
    assert rows["injection off"].earns
    assert "good" in rows["tca"].worse
    assert rows["tca"].earns is None
    off = rows["observer off, guard off"]
    runs = few.study.runs("ebac, observer off, guard off", "pumping")
    assert off.values["least_energy_pumping_J"] == few.study.columns["least_energy_J"][runs].min()


def test_only_what_matters_counts_as_a_difference() -> None:
    known = {measure.key: measure for measure in MEASURES}
    good, energy, ripple = (known[k] for k in ("good", "least_energy_let_go_J", "force_swing_N"))
    assert [good.gain(value, 59, 60) for value in (57, 58, 59, 60)] == [-1, 0, 0, 0]
    assert [good.gain(value, 1, 2) for value in (0, 1, 2)] == [-1, 0, 1]
    assert [energy.gain(v, -1e-3, 60) for v in (-2e-3, -1.4e-3, 0.0)] == [-1, 0, 1]
    assert [ripple.gain(v, 1.0, 60) for v in (0.8, 0.95, 1.05, 1.2)] == [1, 0, 0, -1]
    assert (ripple.gain(None, 1.0, 60), ripple.gain(1.0, None, 60)) == (-1, 1)
    assert ripple.gain(None, None, 60) == 0


def test_measures_have_a_unit_in_their_key() -> None:
    for measure in MEASURES:
        assert measure.unit == "hands" or measure.key.endswith("_" + measure.unit), measure.key


# --- the command ---


def command(*words: object, code: int = 0) -> Any:
    result = CliRunner().invoke(app, ["ablation", *(str(word) for word in words)])
    assert result.exit_code == code, result.output
    return result


@pytest.fixture
def hands_csv(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    FEW[:1].to_csv(tmp_path / "hands.csv")
    return tmp_path / "hands.csv"


@pytest.mark.slow
def test_the_command_writes_tables_and_a_figure(hands_csv: Path) -> None:
    words = (
        "--population",
        hands_csv,
        "--beside",
        "eba",
        "--change",
        "observer=off,guard=off",
        "--out",
        "out",
    )
    shown = " ".join(command(*words).stdout.split())
    assert "injection off (virtual damping while in contact): worse" in shown
    assert "observer off, guard off: worse" in shown
    assert "Red, in the figure orange: worse than ebac as it is; green, in the figure blue" in shown
    out = hands_csv.parent / "out"
    names = {file.name for file in out.iterdir()} - {"sweep"}
    assert names == {"ablation.csv", "ablation.json", "ablation.png", "population.csv", "runs.csv"}
    rows = json.loads((out / "ablation.json").read_text())["rows"]
    assert [list(row) for row in rows] == [KEYS] * len(rows)
    [mine] = [row for row in rows if row["piece"] == "observer, guard"]
    assert mine["changes"] == {"observer": False, "guard": False}
    assert rows[-1]["law"] == "eba"
    with (out / "ablation.csv").open() as file:
        assert list(next(csv.reader(file))) == KEYS


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--change", "kp"), "--change kp: must be NAME=VALUE"),
        (("--change", "kp=x"), "--change kp=x: must be NAME=VALUE"),
        (("--change", "=1"), "--change =1: must be NAME=VALUE"),
        (("--change", "kp=2"), "EBAC.kp = 2: must lie in [0, 0.5]"),
        (("--change", "kpp=0"), "kpp"),
        (("--law", "direct"), "direct has no boolean parameter"),
        (("--law", "all"), "--law all"),
        (("--beside", "ebax"), "--beside ebax: no such name, did you mean 'eba'"),
        (("--resume", "--json"), "give it with --out"),
        (("--hands", "3"), "only a random population has a size"),
    ],
)
def test_what_cannot_be_asked_is_refused(
    words: tuple[str, ...], message: str, hands_csv: Path
) -> None:
    text = " ".join(command(*words, code=2).output.split())
    assert message in text
    assert list(hands_csv.parent.iterdir()) == [hands_csv]


def test_the_figure_colours_what_differs(few: Ablation) -> None:
    from ebac.plot import plot_ablation
    from ebac.plot.ablation import WORSE

    [ax] = plot_ablation(few).axes
    assert [label.get_text() for label in ax.get_yticklabels()] == [r.label for r in few.rows]
    shades = [patch.get_facecolor() for patch in ax.patches]
    assert len(shades) == len(few.rows) * len(MEASURES)
    worse = sum(len(row.worse) for row in few.rows)
    from matplotlib.colors import to_rgba

    assert sum(np.allclose(shade, to_rgba(WORSE)) for shade in shades) == worse
