"""Named changes to a scenario: what a condition is made of. Each takes a scenario with a hand on it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial, wraps
from math import pi, sin
from typing import TYPE_CHECKING, Any, ParamSpec, TypeAlias, TypeVar, cast

from ebac._core import DeviceFacts, Hand, MinimumJerk, Recorded, Sine, Step, Tapping, Timing, Wall

if TYPE_CHECKING:
    from ebac.scenario import Scenario

Change: TypeAlias = Callable[["Scenario"], "Scenario"]
Belief: TypeAlias = Callable[["Scenario"], tuple[DeviceFacts, Timing]]
Arguments = ParamSpec("Arguments")
Made = TypeVar("Made", bound=Callable[["Scenario"], Any])


class _Remade:
    """A function that can be pickled: by what it was made from."""

    def __init__(self, made: Callable[[Scenario], Any], *by: Any) -> None:
        self._made, self._by = made, by

    def __call__(self, scenario: Scenario) -> Any:
        return self._made(scenario)

    def __reduce__(self) -> tuple[Any, ...]:
        make, values, named = self._by
        return partial(make, **named), values


def _remade(make: Callable[Arguments, Made]) -> Callable[Arguments, Made]:
    """Decorate a function that makes a change, so that the change can be pickled."""

    @wraps(make)
    def wrapped(*values: Arguments.args, **named: Arguments.kwargs) -> Made:
        return cast(Made, _Remade(make(*values, **named), wrapped, values, named))

    return wrapped


@_remade
def together(*changes: Change) -> Change:
    """Return all changes, one after the other."""

    def change(scenario: Scenario) -> Scenario:
        for one in changes:
            scenario = one(scenario)
        return scenario

    return change


@_remade
def scenario(**values: Any) -> Change:
    """Change the scenario itself: seconds, jitter, seed."""
    return lambda s: s.replace(**values)


@_remade
def timing(**values: Any) -> Change:
    """Change sample time or delay."""
    return lambda s: s.replace(timing=s.timing.replace(**values))


@_remade
def wall(**values: Any) -> Change:
    """Change the wall."""
    return lambda s: s.replace(environment=_wall(s).replace(**values))


@_remade
def hand(**values: Any) -> Change:
    """Change the hand: tremor, letting go."""
    return lambda s: s.replace(hand=s.hand.replace(**values))


@_remade
def device(part: str, **values: Any) -> Change:
    """Change one part of the device."""
    return lambda s: s.replace(
        device=s.device.replace(**{part: getattr(s.device, part).replace(**values)})
    )


@_remade
def untold(change: Change, *, declared: Change | None = None) -> Change:
    """Change a scenario; its observer, if it has one, is designed before, or for another change that is `declared`."""

    def hidden(s: Scenario) -> Scenario:
        observer = (s if declared is None else declared(s)).designed_observer()
        return change(s).replace(observer=False if observer is None else observer)

    return hidden


@_remade
def device_mass(mass: float) -> Change:
    """Give the device a mass at the handle [kg], handle and rotor in the same shares."""

    def change(s: Scenario) -> Scenario:
        share = mass / s.device.mass
        mechanics, motor = s.device.mechanics, s.device.motor
        lighter = s.device.replace(
            mechanics=mechanics.replace(handle_mass=share * mechanics.handle_mass),
            motor=motor.replace(rotor_inertia=share * motor.rotor_inertia),
        )
        return s.replace(device=lighter)

    return change


@_remade
def approach(way: float) -> Change:
    """Set the free motion of the hand before contact with the wall [m]; 0 starts on the surface."""

    def change(s: Scenario) -> Scenario:
        path = s.hand.path[0]
        if not isinstance(path, Step):
            raise TypeError(f"the hand follows a {type(path).__name__}: an approach needs a Step")
        wall = _wall(s)
        moved = path.replace(target=path.target - wall.position + way)
        hand = s.hand.replace(path=[moved, *s.hand.path[1:]])
        return s.replace(hand=hand, environment=wall.replace(position=way))

    return change


@_remade
def slow_press(duration: float) -> Change:
    """Let the hand reach its target along a minimum-jerk path of this many seconds."""
    return _path(lambda target, surface: MinimumJerk(target=target, duration=duration))


@_remade
def waves(amplitude: float, frequency: float, seconds: float) -> Change:
    """Let the hand's target swing about its place [m], [Hz] for this many seconds, then rest there."""
    times = [0.01 * i for i in range(round(100 * seconds) + 1)]
    swing = [amplitude * sin(2 * pi * frequency * t) for t in times]
    return _path(lambda target, surface: Recorded(t=times, x=[target + x for x in swing]))


@_remade
def held(seconds: float) -> Change:
    """Replace the hand by one that moves 30 mm over 3 s, from 10 mm before the wall, and holds [s].

    0.05 kg, 20 N s/m, 1000 N/m: with it one encoder count of a wall of 10 kN/m toggles without end.
    """

    def change(s: Scenario) -> Scenario:
        path = MinimumJerk(target=0.03, duration=3.0)
        holding = Hand(mass=0.05, damping=20.0, stiffness=1000.0, path=path)
        return s.replace(hand=holding, environment=_wall(s).replace(position=0.01), seconds=seconds)

    return change


@_remade
def tapping(frequency: float, lift: float = 0.01) -> Change:
    """Let the hand tap [Hz]: half a period at its target, half `lift` [m] before the surface."""
    return _path(
        lambda target, surface: Tapping(target=target, rest=surface - lift, frequency=frequency)
    )


@_remade
def pump(amplitude: float, frequency: float, depth: float = 2e-3) -> Change:
    """Replace the hand by a stiff position drive that swings [m], [Hz] around a depth [m] inside the wall.

    20 kN/m; 0.15 kg and 100 N s/m keep its own resonance with the device well damped. Its centre lies deeper by what
    the wall pushes it back at rest.
    """

    def change(s: Scenario) -> Scenario:
        stiffness = 20e3
        inside = depth * (1 + _wall(s).stiffness / stiffness)
        path = Sine(centre=_wall(s).position + inside, amplitude=amplitude, frequency=frequency)
        driven = Hand(mass=0.15, damping=100.0, stiffness=stiffness, path=path)
        return s.replace(hand=driven)

    return change


def observer_of(s: Scenario, facts: DeviceFacts, timing: Timing) -> Scenario:
    """Give the observer of a scenario, if it has one, the facts that laws are designed from."""
    designed = s.designed_observer()
    if designed is None or (facts, timing) == truth(s):
        return s
    believed = designed.replace(
        mass=facts.mass, damping=max(0.0, facts.damping), count=facts.count,
        current_lag=facts.current_lag, delay=timing.delay,
    )  # fmt: skip
    return s.replace(observer=believed)


def truth(s: Scenario) -> tuple[DeviceFacts, Timing]:
    """Return what laws are designed for when nothing is mistaken."""
    return s.device.facts, s.known_timing


@_remade
def mistaken(*, delay: int | None = None, **factors_or_values: float) -> Belief:
    """Return what laws are designed for when some facts are wrong: `damping`, `mass` as factors, others as values."""

    def believe(s: Scenario) -> tuple[DeviceFacts, Timing]:
        facts = s.device.facts
        wrong = {
            name: value * getattr(facts, name) if name in ("damping", "mass") else value
            for name, value in factors_or_values.items()
        }
        timing_known = s.known_timing if delay is None else s.known_timing.replace(delay=delay)
        return facts.replace(**wrong), timing_known

    return believe


def _wall(s: Scenario) -> Wall:
    if not isinstance(s.environment, Wall):
        raise TypeError(
            f"the environment is a {type(s.environment).__name__}: must be a Wall, which a named condition changes; "
            "ebac.sweep(operators.scenarios(base), laws) takes any world"
        )
    return s.environment


def _path(make: Callable[[float, float], Any]) -> Change:
    def change(s: Scenario) -> Scenario:
        path = s.hand.path[0]
        if not hasattr(path, "target"):
            raise TypeError(f"the hand follows a {type(path).__name__}, which has no target")
        made = make(path.target, _wall(s).position)
        return s.replace(hand=s.hand.replace(path=[made, *s.hand.path[1:]]))

    return change
