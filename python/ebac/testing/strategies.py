"""Hypothesis strategies: hands, devices, walls, timings, scenarios, ports, parameters. SI units throughout.

The ranges are those of people and of devices like the paper's, not the widest the core accepts; every keyword narrows
or widens one.
"""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from ebac import _core
from ebac._core import (
    Device,
    Encoder,
    ForceSensor,
    Free,
    Gimbal,
    Hand,
    Linear,
    Mechanics,
    Port,
    SlidingGimbal,
    Step,
    Timing,
    Wall,
)
from ebac.operators import MOST_PULL
from ebac.scenario import Scenario

Range = tuple[float, float]


def hands(
    *,
    mass: Range = (0.005, 3.0),
    damping: Range = (0.1, 40.0),
    stiffness: Range = (0.0, 1500.0),
    target: Range = (0.0, 0.06),
    most_pull: float = MOST_PULL,
    open_hand: bool = True,
    tremor: bool = False,
    lets_go: bool = False,
) -> st.SearchStrategy[Hand]:
    """Draw hands of eq. (4) from a finger to a whole arm, and an open hand.

    Parameters
    ----------
    mass, damping, stiffness : (low, high)
        M0 [kg], B0 [N s/m], K0 [N/m].
    target : (low, high)
        Where the hand wants to be, X0 [m]; brought nearer where it would pull with more than `most_pull`.
    most_pull : float
        Largest K0 X0 [N].
    open_hand : bool
        Whether to draw nobody holding the device too.
    tremor : bool
        Whether to draw a tremor of up to 1 mm at 4 to 12 Hz too.
    lets_go : bool
        Whether to draw hands that let go after 0.05 to 2 s too.
    """

    def build(m: float, b: float, k: float, x: float, a: float, f: float, release: float) -> Hand:
        reach = min(abs(x), most_pull / k) if k > 0 else abs(x)
        path = Step(target=reach if x >= 0 else -reach)
        return Hand(mass=m, damping=b, stiffness=k, path=path, tremor_amplitude=a,
                    tremor_frequency=f, release_at=release)  # fmt: skip

    never = st.just(float("inf"))
    held = st.builds(
        build,
        st.floats(*mass),
        st.floats(*damping),
        st.floats(*stiffness),
        st.floats(*target),
        st.floats(0, 1e-3) if tremor else st.just(0.0),
        st.floats(4, 12),
        never | st.floats(0.05, 2.0) if lets_go else never,
    )
    nobody = st.just(Hand(mass=0, damping=0, stiffness=0, path=Step(target=0)))
    return held | nobody if open_hand else held


def devices(
    *,
    axes: int | None = 1,
    mass: Range = (0.05, 0.6),
    damping: Range = (0.2, 10.0),
    friction: Range = (0.0, 0.0),
    noise: Range = (0.0, 0.0),
) -> st.SearchStrategy[Device]:
    """Draw devices built from the paper's motor and capstan.

    Parameters
    ----------
    axes : int or None
        Straight axes, 1 to 3; None draws one or two straight axes, or the paper's gimbal without and with a slide.
    mass : (low, high)
        Of lever and handle, without the rotor [kg].
    damping, friction : (low, high)
        Viscous [N s/m] and Coulomb [N], at the handle.
    noise : (low, high)
        Standard deviation of the force sensor [N].
    """
    straight = st.just(axes) if axes is not None else st.integers(1, 2)
    kinematics: st.SearchStrategy[Linear | Gimbal | SlidingGimbal] = straight.map(
        lambda n: Linear(axes=n)
    )
    if axes is None:
        kinematics = kinematics | st.sampled_from([Gimbal(), SlidingGimbal()])
    return st.builds(
        Device,
        kinematics=kinematics,
        mechanics=st.builds(
            Mechanics,
            handle_mass=st.floats(*mass),
            damping=st.floats(*damping),
            coulomb=st.floats(*friction),
        ),
        sensor=st.builds(ForceSensor, noise=st.floats(*noise)),
        encoder=st.sampled_from([512, 1024, 4096]).map(lambda n: Encoder(counts_per_turn=n)),
    )


def walls(
    *,
    stiffness: Range = (100.0, 50e3),
    damping: Range = (0.0, 0.0),
    position: Range = (0.0, 0.02),
    free: bool = False,
) -> st.SearchStrategy[Any]:
    """Draw walls across the first axis, eq. (12).

    Parameters
    ----------
    stiffness, damping, position : (low, high)
        K [N/m], B [N s/m], place of the surface [m].
    free : bool
        Whether to draw free air too.
    """
    some = st.builds(
        Wall,
        stiffness=st.floats(*stiffness),
        damping=st.floats(*damping),
        position=st.floats(*position),
    )
    return some | st.just(Free()) if free else some


def timings(
    *, dt: Range = (2.5e-4, 4e-3), delay: tuple[int, int] = (0, 2), jitter: Range = (0.0, 0.0)
) -> st.SearchStrategy[Timing]:
    """Draw sample times [s], whole delays [samples] and the jitter of a design, a share of the sample time."""
    return st.builds(
        Timing, dt=st.floats(*dt), delay=st.integers(*delay), jitter=st.floats(*jitter)
    )


def scenarios(
    *,
    device: st.SearchStrategy[Device] | None = None,
    hand: st.SearchStrategy[Hand] | None = None,
    environment: st.SearchStrategy[Any] | None = None,
    timing: st.SearchStrategy[Timing] | None = None,
    seconds: float = 1.0,
    jitter: Range = (0.0, 0.0),
) -> st.SearchStrategy[Scenario]:
    """Draw whole scenarios, `seconds` long, from the strategies above unless others are given."""
    return st.builds(
        Scenario,
        device=devices() if device is None else device,
        hand=hands() if hand is None else hand,
        environment=walls() if environment is None else environment,
        timing=timings(dt=(1e-3, 1e-3)) if timing is None else timing,
        seconds=st.just(seconds),
        jitter=st.floats(*jitter),
        seed=st.integers(0, 2**31),
    )


def ports(*, extreme: bool = False) -> st.SearchStrategy[Port]:
    """Draw what a law may see in one tick, one independent of the other.

    Parameters
    ----------
    extreme : bool
        Whether to draw any size up to 1e50 too; beyond, squares and quotients leave the range of a double.
    """
    plausible = st.builds(
        Port,
        x=st.floats(-0.1, 0.1),
        dx=st.just(0.0) | st.floats(-0.01, 0.01),
        v=st.floats(-5, 5),
        dt=st.just(0.0) | st.floats(1e-4, 2e-3),
        f_env=st.just(0.0) | st.floats(-200, 200),
        f_applied=st.floats(-42.4, 42.4),
        f_meas=st.floats(-145, 145),
    )
    if not extreme:
        return plausible
    size = st.floats(1e-50, 1e50)
    huge = st.just(0.0) | size | size.map(lambda value: -value)
    dt = st.just(0.0) | st.floats(1e-9, 1e3)
    return plausible | st.builds(
        Port, x=huge, dx=huge, v=huge, dt=dt, f_env=huge, f_applied=huge, f_meas=huge
    )


def values(field: _core.Field) -> st.SearchStrategy[Any]:
    """Draw a value that a parameter accepts: any in its range."""
    if field.kind == "bool":
        return st.booleans()
    if field.kind == "int":
        return st.integers(int(field.low), int(field.high))
    return st.floats(field.low, field.high)


def parameters(owner: Any) -> st.SearchStrategy[dict[str, Any]]:
    """Draw keyword arguments for a class with a field list: a law, `Timing`, `Wall`, ..."""
    return st.fixed_dictionaries({field.name: values(field) for field in owner.fields()})
