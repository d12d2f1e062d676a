"""`tune` and the tuned laws of the package."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac import laws
from ebac.cli import app
from ebac.laws import design
from ebac.laws.tuned_laws import tuned, tuned_laws
from ebac.studies import TuningInterrupted, tune, tuning

FEW = ebac.Operators.sample(3, 5)
#: What the package has, by the ending of the laws' names.
TABLES = {
    ending: json.loads(Path(laws.__file__).with_name(file).read_text(encoding="utf-8"))["rows"]
    for ending, file in (
        ("-tuned", "tuned_rivals.json"),
        ("-tuned-observer", "tuned_rivals_observer.json"),
    )
}
ROWS = [(ending, row) for ending, rows in TABLES.items() for row in rows]
NOISY = ebac.Scenario(device=ebac.Device(sensor=ebac.ForceSensor(noise=0.03)))


class NoFields:
    """The force of the world and no parameter."""

    def step(self, port: ebac.Port) -> float:
        return port.f_env

    def reset(self) -> None:
        pass


@dataclass
class Own(NoFields):
    """A damper in contact."""

    damping: Any = field(default=90.0, metadata={"unit": "N s/m", "low": 1, "high": 100})
    steps: int = field(default=1, metadata={"low": 0, "high": 3})
    on: bool = True

    def step(self, port: ebac.Port) -> float:
        assert isinstance(self.steps, int)
        return port.f_env + self.damping * port.v if port.f_env > 0 else 0.0


@dataclass
class Bare(NoFields):
    gain: float = 2.0


@dataclass
class Wordy(NoFields):
    gain: float = field(default=2.0, metadata={"low": "few", "high": 3})


def quick(law: str = "tca-damped", conditions: Any = ("d1K20",), **more: Any) -> Any:
    base = ebac.Scenario(seconds=1.5)
    given = {"training": FEW, "test": FEW, "base": base, "evaluations": 12, "threads": 1, **more}
    return tune(law, conditions, **given)


def test_the_best_is_no_worse_than_the_design_and_both_are_judged_on_the_test_hands() -> None:
    seen: list[tuple[int, int]] = []
    other = ebac.Operators.sample(2, 9)
    (found,) = quick(test=other, progress=lambda done, total: seen.append((done, total)))
    assert found.cost < found.default_cost
    assert found.tried == 12
    assert found.delay == 1
    assert [row.hands for row in (*found.default, *found.test)] == [2, 2]
    assert seen[-1] == (12, 12)
    low, high = tuning.RANGES["tca-damped"]["virtual_damping"]
    assert low <= found.changes["virtual_damping"] <= high
    assert found.row()["parameters"] == (
        {"name": "virtual_damping", "value": found.changes["virtual_damping"], "unit": "N s/m", "low": 5, "high": 200},
        {"name": "kp", "value": found.changes["kp"], "unit": "1", "low": 0, "high": 1},
    )  # fmt: skip
    rows = ebac.study(other, found.variant, ["d1K20"], base=ebac.Scenario(seconds=1.5)).rows
    assert rows[0].good == found.test[0].good


@pytest.mark.parametrize(("ending", "row"), ROWS)
def test_the_package_keeps_what_a_search_prints(ending: str, row: dict[str, Any]) -> None:
    """The ranges that were searched were missing, without which no search can be repeated."""
    searched = tuning.ranges.Ranges(row["law"], tuning.RANGES[row["law"]]).searched(row["changes"])
    assert row["parameters"] == list(searched)
    assert row["observer"] is (ending == "-tuned-observer")
    given = {one["name"]: one["value"] for one in row["parameters"] if one["value"] is not None}
    assert given == row["changes"]


def test_a_law_in_python_is_tuned_within_the_ranges_that_its_fields_declare() -> None:
    base = ebac.Scenario(seconds=0.6)
    (found,) = quick(Own(), base=base, training=FEW[:1], test=FEW[:1])
    assert (found.law, found.tried) == ("Own", 12)
    assert found.changes.keys() == {"damping", "steps"}
    assert 1 <= found.changes["damping"] <= 100
    assert found.variant == replace(Own(), **found.changes)
    assert found.cost < found.default_cost
    assert "variant" not in found.row()
    rows = ebac.study(FEW[:1], found.variant, ["d1K20"], base=base).rows
    assert rows[0].most_drawn_J == found.test[0].most_drawn_J


def test_a_parameter_at_a_bound_of_its_range_is_named_with_a_remedy() -> None:
    """A search ended at a bound without a word."""
    own = tuning.ranges.Ranges(Own(), {"damping": (1, 100), "steps": (0, 2)})
    assert own.at_bounds({"damping": 100.0, "steps": 1}) == (
        "damping = 100 N s/m is at its upper bound: raise `high` if it may be more",
    )
    assert own.at_bounds({"damping": 1.0, "steps": 2}) == (
        "damping = 1 N s/m is at its lower bound: reduce `low` if it may be less",
        "steps = 2 is at the end of the range searched, [0, 2]: give a wider one in Python, "
        "ebac.tune(..., ranges=...)",
    )
    assert own.at_bounds({}) == ()
    assert own.searched({})[1] == {"name": "steps", "value": None, "unit": "1", "low": 0, "high": 2}
    built_in = tuning.ranges.Ranges("tca-damped", tuning.RANGES["tca-damped"])
    (one,) = built_in.at_bounds({"virtual_damping": 200.0, "kp": 0.0})
    assert one.startswith(
        "virtual_damping = 200 N s/m is at the end of the range searched, [5, 200] N s/m: "
    )


def test_the_command_notes_a_parameter_at_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tuning.ranges, "AT_BOUND", 1.0)  # as if all were there
    words = "tune sfa -c d1K10 --hands 2 --evaluations 8 --seconds 0.5 --threads 1"
    result = CliRunner().invoke(app, words.split())
    assert result.exit_code == 0, result.output
    assert "Note: sfa, 1 sample of delay: " in result.stderr


def test_each_delay_is_tuned_for_itself_with_the_same_result_every_time() -> None:
    first, second = (
        quick("sfa", ("d0K10", "d1K10", "d1K20"), evaluations=4, threads=n) for n in (1, 2)
    )
    assert [one.delay for one in first] == [0, 1]
    assert [len(one.test) for one in first] == [1, 2]
    assert [one.row() for one in first] == [one.row() for one in second]
    assert isinstance(
        first[0].changes.get("transient", True), bool
    )  # nothing where the design is best


def test_an_interrupt_keeps_the_best_so_far(monkeypatch: pytest.MonkeyPatch) -> None:
    count = 0

    def sweep(*args: Any, **more: Any) -> Any:
        nonlocal count
        count += 1
        if count == 5:
            raise KeyboardInterrupt
        return ebac.sweep(*args, **more)

    monkeypatch.setattr(tuning.search, "sweep", sweep)
    with pytest.raises(TuningInterrupted) as stopped:
        quick(conditions=("d0K20", "d1K20"))
    (found,) = stopped.value.result
    assert found.tried == 4
    assert found.delay == 0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"law": "direct"}, "nothing to tune"),
        ({"law": "tca-dampd"}, "did you mean 'tca-damped'"),
        ({"law": object()}, r"is no law: it needs step\(port\) -> float and reset\(\)"),
        (
            {"law": Bare()},
            r"Bare.gain = 2: declares no low and no high, .*write gain: float = field\(default=2, meta",
        ),
        ({"law": Bare}, r"Bare is a class: give an instance of it, Bare\(...\)"),
        ({"law": Bare(), "ranges": {"gain": (2, math.inf)}}, r"gain from 2 to inf: must lie in"),
        ({"law": Own(), "ranges": {"damping": (2, 101)}}, r"must lie in \[1, 100\] N s/m"),
        ({"law": Wordy()}, "Wordy.gain: an end of its range = 'few': must be a number"),
        (
            {"law": NoFields()},
            "the law NoFields has no parameters to change: .* put @dataclass above its class",
        ),
        ({"ranges": {"kq": (0, 1)}}, "kq"),
        ({"ranges": {"kp": (0, 11)}}, r"kp from 0 to 11: must lie in \[0, 10\]"),
        ({"evaluations": 1}, "must be at least 2"),
    ],
)
def test_what_cannot_be_searched_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises((ValueError, KeyError, TypeError), match=message):
        quick(**given)


def cost(
    good: bool,
    settled: float,
    drawn: float,
    ripple: float,
    *,
    force: float = 0.0,
    felt: float = 0.0,
    away: float = 0.0,
    impact: float = 1.0,
    late: bool = False,
) -> float:
    columns = {
        "settled_s": settled, "force_settled_s": force, "most_drawn_J": drawn, "force_swing_N": ripple,
        "perceived": felt, "swing_m": 0.0, "rest_m": away, "ideal_m": 0.0, "allowed_m": 0.0,
        "impact_share": impact,
    }  # fmt: skip
    runs = {name: np.array([value]) for name, value in columns.items()}
    flags = {
        name: np.array([is_so])
        for name, is_so in (("quiet", good), ("still", True), ("settled_in_time", not late))
    }
    return tuning.cost_of(ebac.SweepResult({**runs, **flags}))


def test_a_good_hand_more_outweighs_settling_energy_and_ripple() -> None:
    nothing, all_wrong = cost(True, 0, 0, 0), cost(True, math.nan, math.inf, math.inf)
    assert nothing == 0
    assert all_wrong == pytest.approx(0.3)
    assert cost(False, 0, 0, 0) >= 1
    assert cost(True, 0.1, 0, 0) < cost(True, 0.2, 0, 0)
    assert cost(True, 0.1, 0, 0) < cost(True, 0.1, 1e-3, 0)


def test_the_force_counts_as_the_position_does() -> None:
    assert cost(True, 0.1, 0, 0, force=0.3) == cost(True, 0.3, 0, 0, force=0.1)
    assert cost(False, 0.1, 0, 0, felt=4) < cost(False, 0.1, 0, 0, felt=20)
    # But a hand that rests elsewhere is worse, however quiet it is.
    assert cost(False, 0, 0, 0, felt=1e6) < cost(False, 0, 0, 0, away=1e-4)
    assert cost(False, 0, 0, 0, away=1e-3) < cost(False, 0, 0, 0, away=2e-3)
    # A force that is felt makes a hand bad that is exact and still.
    felt = ebac.study(FEW[:1], "tca-damped", ["d1K10"], base=ebac.Scenario(observer=False)).result()
    assert felt["still"][0]
    assert not felt["force_quiet"][0]
    assert tuning.cost_of(felt) > 1


def test_a_wall_that_lets_the_hand_in_costs_and_a_hand_that_comes_late() -> None:
    assert cost(True, 0.1, 0, 0, impact=0.9) < cost(True, 0.1, 0, 0, impact=0.5)
    assert cost(True, 0.1, 0, 0, impact=1.1) == cost(True, 0.1, 0, 0)  # a damper adds to the wall
    assert cost(True, 0.1, 0, 0, impact=math.nan) == cost(True, 0.1, 0, 0, impact=0)
    assert cost(True, 0.1, 0, 0, late=True) == pytest.approx(cost(True, 0.1, 0, 0) + 0.25)
    with pytest.raises(KeyError, match="settled_in_time"):
        tuning.cost_of(ebac.sweep([ebac.Scenario(seconds=0.1)], "tca"))


def found(**now: Any) -> tuning.Tuned:
    design = tuning.TunedRow(
        condition="d1K10", hands=60, good=60, exact_and_still=60, settled_in_time=60, median_impact_share=1.0,
        median_settled_s=0.1,
        least_energy_J=0.0, most_drawn_J=0.0028, force_swing_N=0.0,
    )  # fmt: skip
    return tuning.Tuned(
        law="eba", variant="eba", delay=1, observer=False, changes={}, tried=20, cost=0.1, default_cost=0.2,
        test=(replace(design, **now),), default=(design,),
    )  # fmt: skip


def test_a_tuned_law_that_does_worse_than_its_design_says_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert not found(most_drawn_J=0.0279).worse  # ten times at most
    assert not found(most_drawn_J=0.0, good=60).worse
    assert len(found(good=59).worse) == 1
    (line,) = found(good=59, most_drawn_J=0.36).worse
    assert line == (
        "eba, d1K10: worse than the design on the test hands: good 60 -> 59 of 60, drawn 2.80 mJ -> 360.00 mJ"
    )
    monkeypatch.setattr("ebac.studies.tune", lambda *_, **__: [found(good=59, most_drawn_J=0.36)])
    done = CliRunner().invoke(app, ["tune", "eba", "--condition", "d1K10"])
    assert "keep the design" in " ".join(done.output.split())


def test_the_command_prints_what_was_found_to_copy_or_that_nothing_was(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An empty list stood before the cost, and `never` for hands of which 60 of 60 were in time."""
    better = {"share": 0.2147, "account": True, "rate": 49020.0}
    results = [
        found(good=0, median_settled_s=None),
        replace(found(), changes=better, observer=True),
    ]
    monkeypatch.setattr("ebac.studies.tune", lambda *_, **__: results)
    lines = CliRunner().invoke(app, ["tune", "eba", "-c", "d1K10"]).stdout
    said = " ".join(lines.split())
    assert "eba, 1 sample of delay: nothing better than the design; cost 0.200, 20 points" in said
    assert "share = 0.2147, account = on, rate = 49020; cost 0.200 -> 0.100, 20 points" in said
    assert "  --change share=0.2147,account=on,rate=49020 --observer-every-law" in lines
    assert said.count("--change") == 1
    assert "never" not in said
    assert "Cost: mean of the training hands, less is better" in said
    assert "delay 1: nothing better; good" in repr(results[0])


def test_a_law_is_tuned_for_the_observer_when_it_acts_on_one() -> None:
    (alone,), (observed,) = (
        quick(base=NOISY.replace(seconds=1.5, observer=given)) for given in (True, "every-law")
    )
    assert not alone.observer
    assert observed.observer
    assert observed.cost < alone.cost
    assert observed.test[0].good > alone.test[0].good
    assert observed.test[0].good <= observed.test[0].exact_and_still


# --- the tuned laws of the package ---


def test_every_law_with_something_to_tune_is_in_the_tables_for_three_delays() -> None:
    for ending, rows in TABLES.items():
        assert {row["law"] for row in rows} == set(tuning.RANGES)
        assert all(row["observer"] == (ending == "-tuned-observer") for row in rows)
        for name in tuning.RANGES:
            assert [row["delay"] for row in rows if row["law"] == name] == [0, 1, 2]
    searched = {f"{name}{end}" for name in tuning.RANGES for end in TABLES}
    assert set(tuned_laws()) == searched
    assert not set(tuned_laws()) & set(ebac.LAWS)


@pytest.mark.parametrize(
    ("ending", "row"), ROWS, ids=[f"{row['law']}{end}-{row['delay']}" for end, row in ROWS]
)
def test_a_tuned_law_is_the_law_with_the_parameters_of_the_table(
    ending: str, row: dict[str, Any]
) -> None:
    timing = ebac.Timing(delay=row["delay"])
    law = design(f"{row['law']}{ending}", ebac.Device(), timing)
    assert law == design(row["law"], ebac.Device(), timing, **row["changes"])
    assert row["cost"] <= row["default_cost"]


def test_a_delay_that_was_not_searched_takes_the_nearest() -> None:
    assert tuned("tca-damped-tuned", 5) == tuned("tca-damped-tuned", 2)
    changed = design("tca-damped-tuned", ebac.Device(), ebac.Timing(), kp=0.25)
    assert changed.kp == 0.25  # type: ignore[union-attr]


def test_a_law_that_is_tuned_for_the_observer_acts_on_it_by_itself() -> None:
    name, short = "tca-damped-tuned-observer", ebac.Scenario(seconds=0.3)
    design = ebac.Observer.of(short.device, short.timing)
    for law in (name, ebac.Variant(name, {"kp": 0.1})):
        wanted = ebac.simulate(short.replace(observer="every-law"), law)
        for observer in (True, design, design.replace(every_law=True)):
            trace = ebac.simulate(short.replace(observer=observer), law)
            assert trace["x"].tobytes() == wanted["x"].tobytes()
    encoder = ebac.simulate(short, "tca-damped-tuned")
    assert encoder.scenario == short
    assert encoder["x"].tobytes() != wanted["x"].tobytes()


def test_a_study_gives_each_law_its_own_use_of_the_observer() -> None:
    names = ["tca-damped-tuned", "tca-damped-tuned-observer", "ebac"]
    together = ebac.study(FEW, names, ["d1K20"], base=NOISY.replace(seconds=1.5))
    every = ebac.study(
        FEW, names[1], ["d1K20"], base=NOISY.replace(seconds=1.5, observer="every-law")
    )
    mine = together.columns["law"] == names[1]
    for column in ("rest_m", "least_energy_J", "settled_s"):
        assert np.array_equal(together.columns[column][mine], every.columns[column], equal_nan=True)
    run = int(np.flatnonzero(mine)[0])
    assert together.trace(run)["x"].tobytes() == every.trace(0)["x"].tobytes()


def test_without_an_observer_a_law_tuned_for_it_is_refused() -> None:
    name, bare = "tca-damped-tuned-observer", ebac.Scenario(seconds=0.1, observer=False)
    calls: list[Callable[[], Any]] = [
        lambda: ebac.simulate(bare, name),
        lambda: ebac.study(FEW[:1], [name, "ebac"], ["d1K10"], base=bare),
        lambda: ebac.worst(name, base=bare),
    ]
    for call in calls:
        with pytest.raises(ValueError, match="observer, which is off; turn it on with observer=T"):
            call()


@pytest.mark.parametrize(
    "words",
    ["study --seconds 0.1 --no-observer -c d1K10", "run joystick.toml --virtual"],
)
def test_a_command_says_how_to_turn_the_observer_on(
    words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    CliRunner().invoke(app, ["demo", "joystick"])
    done = CliRunner().invoke(app, [*words.split(), "--law", "tca-damped-tuned-observer"])
    assert done.exit_code == 2
    assert "turn it on with --observer, or use tca-damped-tuned" in " ".join(done.stderr.split())


@pytest.mark.parametrize("ending", TABLES)
def test_the_tables_hold_what_their_laws_do_today(ending: str) -> None:
    """Where a law or a measure has changed: the commands of docs/explanation/rivals.md."""
    (row,) = (r for r in TABLES[ending] if r["law"] == "tca-damped" and r["delay"] == 1)
    law = f"tca-damped{ending}"
    found = ebac.study(ebac.Operators.grid(), law, ["d1K20"], base=NOISY).rows[0]
    (then,) = (one for one in row["test"] if one["condition"] in ("d1K20", "d1b2K20"))
    assert found.good == then["good"]
    assert found.least_energy_J == pytest.approx(then["least_energy_J"], abs=1e-3)


def test_the_command_searches_and_prints_what_was_found() -> None:
    words = "tune eba -c d1K10 --hands 2 --evaluations 3 --seconds 0.5 --threads 1"
    result = CliRunner().invoke(app, [*words.split(), "--json"])
    answer = json.loads(result.stdout)
    assert [(row["law"], row["observer"]) for row in answer["rows"]] == [("eba", False)]
    assert answer["complete"]
    shown = CliRunner().invoke(app, [*words.split(), "--observer-every-law"]).stdout
    assert "eba, 1 sample of delay, on the observer: share = " in shown.replace("\n", " ")


def test_the_command_writes_what_it_prints_where_it_is_told_to(tmp_path: Path) -> None:
    folder = tmp_path / "tuned"
    words = f"tune tca-damped -c d1K10 --hands 2 --evaluations 3 --json --out {folder}"
    said = CliRunner().invoke(app, words.split())
    assert said.exit_code == 0, said.output
    assert json.loads((folder / "tune.json").read_text()) == json.loads(said.stdout)
    lines = (folder / "tune.csv").read_text().splitlines()
    assert lines[0].startswith("law,parameters,condition,hands,good,")
    assert [line.split(",")[1] for line in lines[1:]] == ["designed", "tuned"]
    again = CliRunner().invoke(app, words.split())
    assert again.exit_code == 2
    assert "has files; give a new folder" in again.output


def test_an_interrupt_while_a_result_is_judged_keeps_those_before(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    judged = tuning.run._judged

    def interrupted(search: Any, delay: int, *rest: Any) -> Any:
        if delay == 1:
            raise KeyboardInterrupt
        return judged(search, delay, *rest)

    monkeypatch.setattr(tuning.run, "_judged", interrupted)
    with pytest.raises(TuningInterrupted) as stopped:
        quick(conditions=("d0K20", "d1K20"), evaluations=3)
    assert [found.delay for found in stopped.value.result] == [0]
