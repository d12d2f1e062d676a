"""The same scenario gives the same bits, today and tomorrow.

The golden traces hold every 10th row of x and f_cmd of each law in the reference scenario, and
what the whole run comes to. After a change that is meant to change them: `pytest --ebac-update`,
look at the difference in the metrics, and say in the changelog why.
"""

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import ebac
from ebac.testing import Tolerance
from ebac.testing.golden import TraceRegression

GOLDEN = Path(__file__).parents[1] / "golden"
every_law = pytest.mark.parametrize("name", ebac.LAWS)
#: The laws as they run by default, and `ebac` on the encoder alone.
GOLDEN_LAWS = [*ebac.LAWS, "ebac-encoder"]

NOISY = ebac.Scenario(
    device=ebac.Device(
        kinematics=ebac.Linear(axes=2),
        sensor=ebac.ForceSensor(noise=0.2),
        mechanics=ebac.Mechanics(coulomb=0.3),
    ),
    environment=ebac.Corner(),
    hand=ebac.Hand(path=[ebac.Step(), ebac.Sine(frequency=2.0)]),
    seconds=0.5,
    jitter=0.3,
    seed=7,
)


def same(one: ebac.Trace, other: ebac.Trace) -> set[str]:
    """The columns that agree to the bit."""
    return {name for name in one if one[name].tobytes() == other[name].tobytes()}


@every_law
def test_the_same_scenario_gives_the_same_bits(name: str) -> None:
    first, second = (ebac.simulate(NOISY, name) for _ in range(2))
    assert same(first, second) == set(first)


@every_law
def test_another_seed_gives_another_noise_and_jitter(name: str) -> None:
    first, second = (ebac.simulate(NOISY.replace(seed=seed), name) for seed in (7, 8))
    assert not {"lateness", "f_meas", "t"} & same(first, second)


def test_without_noise_and_jitter_a_seed_places_zero_within_a_count() -> None:
    quiet = ebac.Scenario(environment=ebac.Free(), seconds=0.5, observer=False)
    first, second = (ebac.simulate(quiet.replace(seed=seed), "direct") for seed in (1, 2))
    assert set(first) - same(first, second) == {"counts", "q", "dq", "x", "dx", "v", "damped"}
    phase = [(trace["x"] - trace["true.x"]).mean() for trace in (first, second)]
    assert 0.01 < abs(phase[0] - phase[1]) / quiet.device.count < 1


def test_jitter_does_not_use_the_numbers_of_the_noise() -> None:
    """One seed, two streams: turning jitter on leaves the noise of the sensor as it was."""
    device = ebac.Device(sensor=ebac.ForceSensor(noise=0.2))
    scenario = ebac.Scenario(device=device, environment=ebac.Free(), seconds=0.2)
    noise = [
        trace["f_meas"] - trace["true.f_sensor"]
        for trace in (ebac.simulate(scenario.replace(jitter=j), "direct") for j in (0.0, 0.3))
    ]
    assert noise[0] == pytest.approx(noise[1], abs=1e-12)


def test_a_law_may_be_used_again() -> None:
    law = ebac.design("ebac", ebac.Device(), ebac.Timing())
    first, second = (ebac.simulate(ebac.Scenario(seconds=0.3), law) for _ in range(2))
    assert same(first, second) == set(first)


def test_another_process_gives_the_same_bits() -> None:
    code = (
        "import ebac, hashlib;"
        "trace = ebac.simulate(ebac.Scenario(seconds=0.3, jitter=0.2), 'ebac');"
        "print(hashlib.sha256(b''.join(trace[name].tobytes() for name in trace)).hexdigest())"
    )
    found = {
        subprocess.run([sys.executable, "-c", code], check=True, capture_output=True).stdout
        for _ in "ab"
    }
    assert len(found) == 1


# --- golden traces ---


@pytest.mark.parametrize("name", GOLDEN_LAWS)
def test_the_reference_scenario_gives_the_golden_trace(
    name: str, run: Any, ebac_trace: TraceRegression
) -> None:
    alone = name == "ebac-encoder"
    ebac_trace.check(
        run("ebac", observer=False) if alone else run(name),
        name=name,
        columns=("x", "f_cmd"),
        every=10,
        until=0.3,  # A count that toggles one tick later is no fault, but from then on the digits differ.
        tolerances={
            "x": Tolerance(absolute=1e-12, relative=1e-9),
            "f_cmd": Tolerance(absolute=1e-7, relative=1e-9),
        },
        metric_tolerances={
            "rest_m": 1e-4,
            "deviation_m": 1e-4,
            "swing_m": 3e-4,
            "force_swing_N": 3.0,
            "force_step_N": 3.0,
            "settled_s": 0.1,
            "peak_m": 1e-4,
            "limit_cycle_Hz": 0.5,
            "least_energy_J": 0.2,
            "clamped_share": 0.05,
        },
    )


def test_there_is_a_golden_trace_for_each_law_and_none_besides() -> None:
    for ending in ("npz", "json"):
        found = {path.stem for path in GOLDEN.glob(f"*.{ending}")}
        assert {name for name in found if not name.startswith(("world-", "teleop"))} == set(
            GOLDEN_LAWS
        )
