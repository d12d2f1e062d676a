"""A wall that moves and tells so: felt where it is, its work accounted as the world's own."""

import numpy as np
import pytest

import ebac

NOISY = ebac.Device(sensor=ebac.ForceSensor(noise=0.03))
MOVING = ebac.Wall(motion_amplitude=2e-3, motion_frequency=2.0)
OBSERVED = ebac.Scenario(device=NOISY, environment=MOVING, seconds=10.0, observer=True)


def surface(trace: ebac.Trace, wall: ebac.Wall) -> np.ndarray:
    """Where the wall is [m]."""
    return wall.motion_amplitude * np.sin(2 * np.pi * wall.motion_frequency * trace["t"])


def worlds_work(trace: ebac.Trace, delay: int) -> np.ndarray:
    """Work that the world did by its motion [J]: with what it had asked for, as far as it was given."""
    asked = np.r_[np.zeros(delay + 1), trace["f_env"][: -delay - 1]]
    given = np.minimum(trace["f_applied"], asked)
    return -np.cumsum(given * trace["world_v"] * trace["dt"])


def test_the_wall_is_felt_where_it_is_and_says_how_it_moves() -> None:
    trace = ebac.simulate(OBSERVED.replace(seconds=1.0, observer=False), "direct")
    wall, inside = MOVING, trace["f_env"] > 0
    assert trace["f_env"][inside] == pytest.approx(
        1e4 * (trace["x"] - surface(trace, wall))[inside]
    )
    assert np.gradient(surface(trace, wall), trace["t"])[1:-1] == pytest.approx(
        trace["world_v"][1:-1], abs=1e-5
    )


@pytest.mark.parametrize(
    ("amplitude", "frequency"), [(2e-3, 0.5), (2e-3, 2.0), (1e-3, 5.0), (5e-3, 1.0)]
)
@pytest.mark.parametrize("observer", [True, False])
def test_no_moving_wall_lets_the_hand_through(
    amplitude: float, frequency: float, observer: bool
) -> None:
    wall = ebac.Wall(motion_amplitude=amplitude, motion_frequency=frequency)
    scenario = OBSERVED.replace(environment=wall, observer=observer)
    trace = ebac.simulate(scenario, "ebac")
    depth = (trace["true.x"] - surface(trace, wall))[trace["t"] > 1]
    ideal = ebac.ideal_rest(OBSERVED.replace(environment=ebac.Wall()))
    assert ideal is not None
    assert depth.max() < (ideal + 0.5e-3 if observer else 10e-3)
    assert trace["law.starved"].max() < 0.05
    assert (trace["true.energy"] + worlds_work(trace, 1)).min() > -2e-3


@pytest.mark.parametrize("observer", [True, False])
@pytest.mark.parametrize("delay", [0, 2])
def test_the_work_of_a_wall_is_that_of_its_motion_while_the_force_acts(
    delay: int, observer: bool
) -> None:
    wall = ebac.Wall(stiffness=20e3, position=0.005, motion_amplitude=3e-3, motion_frequency=8.0)
    hand = ebac.Hand(mass=1.0, damping=5.0, stiffness=300.0, target=0.03)
    scenario = ebac.Scenario(
        device=NOISY,
        hand=hand,
        environment=wall,
        timing=ebac.Timing(delay=delay),
        seconds=5.0,
        observer=observer,
    )
    trace = ebac.simulate(scenario, "ebac")
    asked = np.r_[np.zeros(delay + 1), trace["f_env"][: -delay - 1]]
    given = np.clip(trace["f_applied"], np.minimum(asked, 0), np.maximum(asked, 0))
    true = float(np.sum(given[1:] * np.diff(surface(trace, wall))))
    assert true < -0.5
    assert ebac.metrics.work_of_surfaces(trace)[-1] == pytest.approx(true, rel=0.03)


def test_a_contact_shows_what_is_drawn_beyond_the_work_of_the_wall() -> None:
    moving = ebac.contact(ebac.simulate(OBSERVED.replace(seconds=2.0), "ebac"))
    assert moving.least_energy_J is not None
    assert moving.least_energy_J < -5e-3
    assert moving.drawn_J == 0
    assert "  drawn               0 mJ" in str(moving)
    still = ebac.contact(
        ebac.simulate(OBSERVED.replace(environment=ebac.Wall(), seconds=2.0), "ebac")
    )
    assert still.drawn_J is None
    assert "  drawn   " not in str(still)


@pytest.mark.parametrize("observer", [True, False])
def test_a_hand_that_pumps_against_a_moving_wall_gets_no_more_than_the_world_gives(
    observer: bool,
) -> None:
    for hand_frequency in (2.0, 4.0):
        pump = ebac.Sine(centre=2e-3, amplitude=3e-3, frequency=hand_frequency)
        hand = ebac.Hand(mass=0.15, damping=100.0, stiffness=20e3, path=[pump])
        trace = ebac.simulate(OBSERVED.replace(hand=hand, observer=observer), "ebac")
        lent = 2e-3 if observer else 10e-3
        assert (trace["true.energy"] + worlds_work(trace, 1)).min() > -lent


def test_a_wall_at_rest_is_the_same_to_the_bit() -> None:
    still = ebac.Wall(motion_frequency=7.0)
    plain = ebac.simulate(OBSERVED.replace(environment=ebac.Wall(), seconds=1.0), "ebac")
    trace = ebac.simulate(OBSERVED.replace(environment=still, seconds=1.0), "ebac")
    assert trace["f_cmd"].tobytes() == plain["f_cmd"].tobytes()
    assert not trace["world_v"].any()


def test_on_a_slant_the_velocity_is_along_the_normal() -> None:
    device = NOISY.replace(kinematics=ebac.Linear(axes=2))
    slant = MOVING.replace(angle=0.6)
    hand = ebac.Hand(target=(0.03, 0.02))
    scenario = OBSERVED.replace(device=device, environment=slant, hand=hand, seconds=4.0)
    trace = ebac.simulate(scenario, "ebac")
    normal = np.array([np.cos(0.6), np.sin(0.6)])
    across = trace["world_v"] @ np.array([-normal[1], normal[0]])
    assert np.abs(across).max() < 1e-12
    depth = (trace["true.x"] @ normal - surface(trace, slant))[trace["t"] > 1]
    assert depth.max() < 2e-3


def test_a_corner_takes_no_wall_that_moves() -> None:
    with pytest.raises(ValueError, match="motion_amplitude"):
        ebac.Corner(first=MOVING)
