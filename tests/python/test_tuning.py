"""`tune` and the tuned laws of the package."""

import json
import math
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.laws import design
from ebac.studies import TuningInterrupted, tune, tuning
from ebac.tuned_laws import tuned, tuned_laws, tuned_text

FEW = ebac.Operators.sample(3, 5)
#: What the package has, by the ending of the laws' names.
TABLES = {
    ending: json.loads(Path(ebac.__file__).with_name(file).read_text(encoding="utf-8"))["rows"]
    for ending, file in (
        ("-tuned", "tuned_rivals.json"),
        ("-tuned-observer", "tuned_rivals_observer.json"),
    )
}
ROWS = [(ending, row) for ending, rows in TABLES.items() for row in rows]
NOISY = ebac.Scenario(device=ebac.Device(sensor=ebac.ForceSensor(noise=0.03)))


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
    rows = ebac.study(other, found.variant, ["d1K20"], base=ebac.Scenario(seconds=1.5)).rows
    assert rows[0].good == found.test[0].good


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
        ({"law": object()}, "search the parameters of your own with ebac.study"),
        ({"ranges": {"kq": (0, 1)}}, "kq"),
        ({"ranges": {"kp": (0, 11)}}, r"kp from 0 to 11 1: must lie in \[0, 10\]"),
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
) -> float:
    columns = {
        "settled_s": settled, "force_settled_s": force, "most_drawn_J": drawn, "force_swing_N": ripple,
        "perceived": felt, "swing_m": 0.0, "rest_m": away, "ideal_m": 0.0, "allowed_m": 0.0,
    }  # fmt: skip
    runs = {name: np.array([value]) for name, value in columns.items()}
    flags = {"quiet": np.array([good]), "still": np.array([True])}
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
    felt = ebac.sweep([ebac.Scenario(observer=False)], ["tca-damped", "direct"])
    assert felt["still"][0]
    assert not felt["force_quiet"][0]
    alone = ebac.SweepResult({name: values[:1] for name, values in felt.columns.items()})
    assert tuning.cost_of(alone) > 1


def test_a_law_is_tuned_for_the_observer_when_it_acts_on_one() -> None:
    (alone,), (observed,) = (
        quick(base=NOISY.replace(seconds=1.5, observer=given)) for given in (True, "every-law")
    )
    assert not alone.observer
    assert observed.observer
    assert observed.changes != alone.changes
    assert observed.test[0].good > alone.test[0].good
    assert observed.test[0].good <= observed.test[0].exact_and_still


# --- the tuned laws of the package ---


def test_every_law_with_something_to_tune_is_in_the_tables_for_three_delays() -> None:
    for ending, rows in TABLES.items():
        assert {row["law"] for row in rows} == set(tuning.RANGES)
        assert all(row["observer"] == (ending == "-tuned-observer") for row in rows)
        for name in tuning.RANGES:
            assert [row["delay"] for row in rows if row["law"] == name] == [0, 1, 2]
    assert set(tuned_laws()) == {f"{name}{end}" for name in tuning.RANGES for end in TABLES}
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


def without_observer(law: Any, base: ebac.Scenario) -> list[str]:
    """Return the files in which a study and a simulation of a law warn, after a look at the text."""
    files = []
    calls: list[Callable[[], Any]] = [
        lambda: ebac.study(FEW[:1], [law, "ebac"], ["d1K10", "d1K20"], base=base),
        lambda: ebac.simulate(base, law),
    ]
    for call in calls:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            call()
        assert len(caught) <= 1  # once a call
        for one in caught:
            assert one.category is UserWarning
            assert str(one.message) == tuned_text("tca-damped-tuned-observer")
            assert 'use it with Scenario(observer="every-law")' in str(one.message)
            files.append(one.filename)
    return files


def test_a_law_that_is_tuned_for_the_observer_warns_without_it() -> None:
    name, short = "tca-damped-tuned-observer", ebac.Scenario(seconds=0.1)
    assert without_observer(name, short) == [__file__] * 2
    assert without_observer(ebac.Variant(name, {"kp": 0.1}), short) == [__file__] * 2
    for given in (
        "every-law",
        ebac.Observer.of(short.device, short.timing).replace(every_law=True),
    ):
        assert without_observer(name, short.replace(observer=given)) == []
    assert without_observer("tca-damped-tuned", short) == []


def test_a_command_prints_a_note_in_place_of_the_warning() -> None:
    words = "study --law tca-damped-tuned-observer --seconds 0.1 --no-files --json"
    done = CliRunner().invoke(app, [*words.split(), "--population", "random", "--hands", "1"])
    assert done.exit_code == 0, done.output  # a warning is an error here
    assert done.stderr.count("use it with --observer-every-law") == 1


@pytest.mark.parametrize("ending", TABLES)
def test_the_tables_hold_what_their_laws_do_today(ending: str) -> None:
    """Where a law or a measure has changed: the commands of docs/explanation/rivals.md."""
    (row,) = (r for r in TABLES[ending] if r["law"] == "tca-damped" and r["delay"] == 1)
    base = NOISY.replace(observer="every-law" if row["observer"] else True)
    law = f"tca-damped{ending}"
    found = ebac.study(ebac.Operators.grid(), law, ["d1K20"], base=base).rows[0]
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
