"""Populations of operators: the grid, random ones, and what a table says that cannot be."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ebac
from ebac import Operators

GOOD: dict[str, Any] = {
    "m_kg": [0.1, 0.2],
    "b_Ns_per_m": [2, 3],
    "k_N_per_m": [100, 200],
    "target_m": [0.02, 0.03],
}
HEADING = "m_kg,b_Ns_per_m,k_N_per_m,target_m\n"


def target(hand: ebac.Hand) -> float:
    path = hand.path[0]
    assert isinstance(path, ebac.Step)
    return path.target


def surface(scenario: ebac.Scenario) -> float:
    assert isinstance(scenario.environment, ebac.Wall)
    return scenario.environment.position


def test_the_grid_has_the_60_hands_that_pull_with_at_most_35_newton() -> None:
    grid = Operators.grid()
    assert len(grid) == 60
    assert (grid.k_N_per_m * grid.target_m).max() <= 35
    assert len(np.unique(np.column_stack([*grid.columns().values()]), axis=0)) == 60
    assert set(grid.m_kg) == {0.05, 0.15, 0.5, 1.0}


def test_a_grid_of_ones_own() -> None:
    grid = Operators.grid(mass=[0.3], damping=[1, 2], stiffness=[500], target=[0.05], tremor_m=1e-4)
    assert len(grid) == 2
    assert grid.tremor_m.tolist() == [1e-4, 1e-4]
    with pytest.raises(ValueError, match="most_pull = 1 N"):
        Operators.grid(most_pull=1)


def test_samples_lie_in_their_ranges_and_depend_on_the_seed_alone() -> None:
    sample = Operators.sample(2000, 7)
    for name, low, high in (
        ("m_kg", 0.03, 1.5),
        ("b_Ns_per_m", 1, 25),
        ("k_N_per_m", 50, 1200),
        ("target_m", 0.01, 0.06),
    ):
        values = getattr(sample, name)
        assert low <= values.min() < low * 1.1
        assert high * 0.8 < values.max() <= high
    assert (sample.k_N_per_m * sample.target_m).max() <= 35
    assert np.median(sample.m_kg) == pytest.approx((0.03 * 1.5) ** 0.5, rel=0.1)
    assert sample == Operators.sample(2000, 7)
    assert sample != Operators.sample(2000, 8)


def test_a_larger_sample_begins_with_the_smaller_one() -> None:
    assert Operators.sample(300, 3)[:11] == Operators.sample(11, 3)


def test_the_bits_of_a_sample_are_those_of_every_machine() -> None:
    first = Operators.sample(1, 1)
    assert first.m_kg[0].hex() == Operators.sample(5, 1).m_kg[0].hex()
    assert first.m_kg[0] == 0.22217277660384008


@pytest.mark.parametrize(("n", "seed"), [(0, 1), (3, -1)])
def test_no_sample_without_size_or_seed(n: int, seed: int) -> None:
    with pytest.raises(ValueError, match="must be at least"):
        Operators.sample(n, seed)


def test_a_hand_that_approaches_starts_before_the_wall() -> None:
    people = Operators(**GOOD, approach_m=0.02)
    assert [target(hand) for hand in people.hands()] == pytest.approx([0.04, 0.05])
    scenarios = people.scenarios(ebac.Scenario(environment=ebac.Wall(position=0.002)))
    assert [surface(s) for s in scenarios] == pytest.approx([0.022, 0.022])
    with pytest.raises(ValueError, match="needs a Wall, the scenario has a Free"):
        people.scenarios(ebac.Scenario(environment=ebac.Free()))


def test_hands_come_through_10_mm_of_free_air_unless_told_otherwise(tmp_path: Path) -> None:
    (tmp_path / "hands.csv").write_text(HEADING + "0.1,2,100,0.02\n")
    for people in (
        Operators.grid(),
        Operators.sample(5, 1),
        Operators(**GOOD),
        Operators.from_csv(tmp_path / "hands.csv"),
    ):
        assert set(people.approach_m) == {0.01}
        assert {surface(s) for s in people.scenarios(ebac.Scenario())} == {0.01}
    assert set(Operators.grid(approach_m=0.0).approach_m) == {0.0}
    disc = ebac.Scenario(environment=ebac.Disc())
    assert Operators.grid(approach_m=0.0).scenarios(disc)[0].environment == disc.environment
    message = (
        "approach_m = 0.01 m: needs a Wall, the scenario has a Disc; start on the surface, as with "
        "Operators.grid(approach_m=0) or Operators.sample(n, seed, approach_m=0)"
    )
    with pytest.raises(ValueError, match=re.escape(message)):
        Operators.grid().scenarios(disc)
    (one,) = Operators.sample(1, 1, approach_m=0).scenarios(disc)
    assert one.environment == disc.environment


def test_hands_have_the_numbers_of_their_row() -> None:
    hand = Operators(**GOOD, tremor_m=[0, 1e-3], tremor_Hz=12).hands()[1]
    assert (hand.mass, hand.damping, hand.stiffness) == (0.2, 3, 200)
    assert (hand.tremor_amplitude, hand.tremor_frequency) == (1e-3, 12)


def test_columns_are_read_only_and_of_one_length() -> None:
    people = Operators(**GOOD)
    with pytest.raises(ValueError, match="read-only"):
        people.m_kg[0] = 3
    with pytest.raises(ValueError, match=r"target_m has the shape \(3,\)"):
        Operators(**GOOD | {"target_m": [1, 2, 3]})
    with pytest.raises(ValueError, match="empty"):
        Operators(m_kg=[], b_Ns_per_m=[], k_N_per_m=[], target_m=[])


def test_csv_and_dataframe_and_back(tmp_path: Path) -> None:
    pd = pytest.importorskip("pandas")
    people = Operators.sample(20, 5, approach_m=0.004)
    people.to_csv(tmp_path / "hands.csv")
    assert Operators.from_csv(tmp_path / "hands.csv") == people
    assert Operators.from_dataframe(people.to_pandas()) == people
    assert Operators.from_dataframe(pd.DataFrame(GOOD)) == Operators(**GOOD)
    assert people.replace(approach_m=0.01) == Operators.sample(20, 5)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file is empty"),
        (HEADING, "no rows below its heading"),
        ("m_kg,b_Ns_per_m,k_N_per_m\n1,2,3\n", "column target_m is missing"),
        (
            "m_kg,b_Ns_per_m,k_N_per_m,target_m,mass\n1,2,3,.1,1\n",
            "column mass: no such name, did you mean 'm_kg'",
        ),
        ("m_kg,m_kg,k_N_per_m,target_m\n1,2,3,.1\n", "column m_kg stands there twice"),
        (HEADING + "1,2,3,.1\n1,2\n", "row 2 has 2 values, the heading 4"),
        (
            HEADING + "1,2,3,.1\n1,two,3,.1\n",
            "row 2: b_Ns_per_m = 'two': must be a number in N s/m",
        ),
        (
            HEADING + "1,2,3,.1\n\n1,2,-3,.1\n",
            r"row 2: k_N_per_m = -3 N/m: must lie in \[0, 100000\] N/m",
        ),
        (HEADING + "nan,2,3,.1\n", "row 1: m_kg = nan kg"),
    ],
)
def test_what_a_file_cannot_mean_is_named(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "hands.csv"
    file.write_text(text)
    with pytest.raises(ValueError, match=message) as refusal:
        Operators.from_csv(file)
    assert str(refusal.value).startswith(f"{file}: ")


def test_a_missing_value_in_a_dataframe_is_named() -> None:
    pd = pytest.importorskip("pandas")
    with pytest.raises(ValueError, match="row 2: target_m"):
        Operators.from_dataframe(pd.DataFrame(GOOD | {"target_m": [0.02, None]}))


def test_an_operator_has_a_name() -> None:
    assert Operators(**GOOD).name(1) == "0.2 kg, 3 N s/m, 200 N/m, 30 mm"
    assert "2 Operators" in repr(Operators(**GOOD))


def test_semicolons_and_decimal_commas_are_read(tmp_path: Path) -> None:
    people = Operators.sample(5, seed=1)
    people.to_csv(tmp_path / "hands.csv")
    text = (tmp_path / "hands.csv").read_text()
    (tmp_path / "de.csv").write_text(text.replace(",", ";").replace(".", ","))
    assert Operators.from_csv(tmp_path / "de.csv") == people
