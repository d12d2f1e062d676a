"""The conditions that have a name, in groups, and how they are found by it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from ebac._util.arguments import require, unknown
from ebac.hands import FingerPad, LetGo, NonlinearGrip, Reflex
from ebac.studies import scenario_changes as to
from ebac.studies.condition import AS_GIVEN, Condition, cell, cell_of, wall_of
from ebac.studies.condition_grammar import GRAMMAR, written_out
from ebac.studies.scenario_changes import Belief, Change


def _robust(
    name: str,
    summary: str,
    *changes: Change,
    believed: Belief = to.truth,
    drives: Iterable[Change] = (),
    at: tuple[int, float] = (1, 10e3),
) -> Condition:
    return Condition(
        name=name,
        summary=summary,
        change=to.together(cell(at[0], None, at[1]), *changes),
        believed=believed,
        drives=tuple(drives),
    )


_FIVE = [
    cell_of("d1K10", 1, None, 10),
    cell_of("d0K10", 0, None, 10),
    cell_of("d2K10", 2, None, 10),
    cell_of("d1K20", 1, None, 20),
    cell_of("d1b1K5", 1, 1, 5),
]
_CELLS = [
    cell_of(f"d{d}b{b}K{k}", d, b, k) for d in (0, 1, 2) for b in (1, 2, 4) for k in (2, 5, 10, 20)
    if (d, b, k) != (1, 1, 5)  # already one of the five
]  # fmt: skip

_DAMPED = [
    Condition(
        name=f"B{b}K{k:g}",
        summary=f"1 sample of delay, a wall of {k:g} kN/m with {b} N s/m",
        change=to.together(cell(1, None, 1e3 * k), to.wall(damping=float(b))),
    )
    for b in (0, 10, 20, 30, 40) for k in (0.1, 0.3, 1, 3, 10)
]  # fmt: skip

_SLOW = to.slow_press(3.0)
_PUMPS = [to.pump(1e-3 * mm, hz) for mm in (0.1, 0.3, 1, 2, 4) for hz in (0.5, 1, 2, 4, 8, 15, 30)]
_WAVES = (to.waves(5e-3, 1.0, 40.0), to.scenario(seconds=60.0))
_LET_GO_LATE = to.hand(release_at=5.0)
_FRICTION, _FRICTION_1 = (to.device("mechanics", coulomb=newton) for newton in (0.3, 1.0))

_ROBUSTNESS = [
    _robust("surface", "the hand starts on the wall's surface, without free air", to.approach(0.0)),
    _robust("surface-K20", "the hand starts on the surface of a wall of 20 kN/m", to.approach(0.0), at=(1, 20e3)),
    _robust("hold", "the hand presses for 120 s", to.scenario(seconds=120.0)),
    _robust("friction-0.3", "Coulomb friction 0.3 N", _FRICTION),
    _robust("friction-1", "Coulomb friction 1 N", _FRICTION_1),
    _robust("encoder-12bit", "4096 counts a turn, a quarter of the count", to.device("encoder", counts_per_turn=4096)),
    _robust("force-noise", "force sensor noise 0.2 N", to.device("sensor", noise=0.2)),
    _robust("jitter", "ticks up to 30 % of a sample early or late", to.scenario(jitter=0.3)),
    _robust("rate-2kHz", "a tick of 0.5 ms", to.timing(dt=0.5e-3)),
    _robust("rate-500Hz", "a tick of 2 ms", to.timing(dt=2e-3)),
    _robust("device-0.1kg", "a device of 0.1 kg at the handle", to.device_mass(0.1)),
    _robust("device-0.6kg", "a device of 0.6 kg at the handle", to.device_mass(0.6)),
    _robust("wall-damping", "a wall with 5 N s/m", to.wall(damping=5.0)),
    _robust("wall-damping-K2", "a wall of 2 kN/m with 10 N s/m", to.wall(damping=10.0), at=(1, 2e3)),
    _robust("torque-permille", "torque in whole thousandths of the rated one", to.device("drive", permille=True)),
    _robust("told-damping+50", "laws designed for 1.5 times the true damping", believed=to.mistaken(damping=1.5)),
    _robust("told-mass+50", "laws designed for 1.5 times the true mass", believed=to.mistaken(mass=1.5)),
    _robust("told-mass-50", "laws designed for half of the true mass", believed=to.mistaken(mass=0.5)),
    _robust("told-delay-1-of-2", "2 samples of delay, laws for 1", to.timing(delay=2), believed=to.mistaken(delay=1)),
    _robust("told-delay-1-of-3", "3 samples of delay, laws for 1", to.timing(delay=3), believed=to.mistaken(delay=1)),
    _robust("told-lag-0.3-of-1", "drive lag 1 ms, laws designed for 0.3 ms", to.device("drive", current_lag=1e-3),
            believed=to.mistaken(current_lag=3e-4)),
    _robust("tremor-9Hz", "tremor of 0.5 mm at 9 Hz", to.hand(tremor_amplitude=0.5e-3, tremor_frequency=9.0)),
    _robust("shaking-25Hz", "shaking of 2 mm at 25 Hz", to.hand(tremor_amplitude=2e-3, tremor_frequency=25.0)),
    _robust("shaking-60Hz", "shaking of 2 mm at 60 Hz", to.hand(tremor_amplitude=2e-3, tremor_frequency=60.0)),
    _robust("shaking-150Hz", "shaking of 2 mm at 150 Hz", to.hand(tremor_amplitude=2e-3, tremor_frequency=150.0)),
    _robust("tapping-1.5Hz", "tapping 1.5 times a second; never at rest", to.tapping(1.5)),
    _robust("tapping-6Hz", "tapping 6 times a second; never at rest", to.tapping(6.0)),
    _robust("slow-press", "the hand takes 3 s to press, along a minimum-jerk path", _SLOW),
    _robust("slow-press-d0", "slow press without delay", _SLOW, at=(0, 10e3)),
    _robust("slow-press-d2", "slow press at 2 samples of delay", _SLOW, at=(2, 10e3)),
    _robust("slow-press-K20", "slow press at 20 kN/m", _SLOW, at=(1, 20e3)),
    _robust("slow-press-d2K20", "slow press at 2 samples of delay and 20 kN/m", _SLOW, at=(2, 20e3)),
    _robust("slow-waves", "the target swings 5 mm at 1 Hz for 40 s, then rests", *_WAVES),
    _robust("slow-waves-K20", "slow waves at 20 kN/m", *_WAVES, at=(1, 20e3)),
    _robust("let-go", "impact, then the hand lets go at 3 s", to.hand(release_at=3.0)),
    _robust("slow-let-go", "slow press, then the hand lets go at 5 s", _SLOW, _LET_GO_LATE),
    _robust("slow-let-go-d2", "slow press at 2 samples of delay, then the hand lets go",
            _SLOW, _LET_GO_LATE, at=(2, 10e3)),
    _robust("slow-let-go-K20", "slow press at 20 kN/m, then the hand lets go", _SLOW, _LET_GO_LATE, at=(1, 20e3)),
    _robust("pumping", "no hands: a drive of 20 kN/m pumps 20 s at 2 mm depth, 0.1 to 4 mm, 0.5 to 30 Hz",
            to.scenario(seconds=20.0), drives=_PUMPS),
]  # fmt: skip

_FAILING = [
    _robust("sensor-stale", "the force sensor falls silent at 1 s", to.device("sensor", stops_at=1.0)),
    _robust("sensor-gap", "the force sensor falls silent from 1 to 1.5 s, during the contact",
            to.device("sensor", stops_at=1.0, resumes_at=1.5)),
    _robust("sensor-gap-impact", "the force sensor falls silent from 30 to 130 ms, about the impact",
            to.device("sensor", stops_at=0.03, resumes_at=0.13)),
    _robust("sensor-repeats", "from 1 s on the force sensor sends its last reading over and over, as if it were new",
            to.device("sensor", stops_at=1.0, repeats=True)),
    _robust("sensor-disconnected", "from 1 s on the force sensor is silent, and its status says disconnected",
            to.device("sensor", stops_at=1.0, disconnects=True)),
    _robust("sensor-saturated", "the force sensor shows 5 N at most, and its status says so",
            to.device("sensor", range=5.0)),
    _robust("sensor-bias", "the force sensor shows 2 N more", to.device("sensor", bias=2.0)),
    _robust("sensor-slow", "the force sensor has a lag of 3 ms", to.device("sensor", lag=3e-3)),
    _robust("sensor-slow-untold", "the force sensor has a lag of 3 ms, and the observer assumes 0.8 ms",
            to.untold(to.device("sensor", lag=3e-3))),
    _robust("sensor-records", "the force sensor gives a record every 1.3 ms, its age known",
            to.device("sensor", period=1.3e-3)),
    _robust("sensor-delay", "the force sensor shows the force of 1 ms ago, and its age is not known",
            to.device("sensor", delay=1e-3)),
    _robust("friction-1-untold", "1 N of Coulomb friction that the device does not declare",
            to.untold(_FRICTION_1)),
    _robust("told-friction+50", "0.3 N of friction, the device declares 0.45 N",
            to.untold(_FRICTION, declared=to.device("mechanics", coulomb=0.45))),
    _robust("cable", "a cable of 100 kN/m between motor and lever", to.device("mechanics", cable_stiffness=1e5)),
    _robust("backlash", "a cable of 100 kN/m with 0.05 mm of play",
            to.device("mechanics", cable_stiffness=1e5, backlash=5e-5)),
    _robust("torque-ripple", "the motor's torque ripples by 0.5 %, 26 times a turn", to.device("motor", ripple=5e-3)),
    _robust("torque-ripple-d2K20", "the same at 2 samples of delay and 20 kN/m",
            to.device("motor", ripple=5e-3), at=(2, 20e3)),
    _robust("current-noise", "the current of the drive has 5 mA of noise", to.device("drive", current_noise=5e-3)),
    _robust("current-offset", "10 mA of current that the drive does not show", to.device("drive", current_offset=0.01)),
]  # fmt: skip
_TOLD = ("told-mass+50", "told-mass-50", "told-delay-1-of-2")
_OTHER = (
    "device-0.1kg",
    "encoder-12bit",
    "friction-1",
    "friction-1-untold",
    "force-noise",
    "jitter",
)

_MODELS = (
    ("reflex", "hands with a stretch reflex of 40 ms, see ebac.hands.Reflex", Reflex()),
    ("finger-pad", "hands behind the pulp of the fingers, see ebac.hands.FingerPad", FingerPad()),
    ("nonlinear-grip", "hands that are twice as stiff at 20 N, see ebac.hands.NonlinearGrip", NonlinearGrip()),
    ("let-go-grip", "hands that let go at 2 s and grip again at 2.5 s, see ebac.hands.LetGo", LetGo()),
)  # fmt: skip
_HANDS = [
    *(_robust(name, summary, to.hand(model=model)) for name, summary, model in _MODELS),
    *(
        _robust(
            f"{name}-d2K20",
            f"`{name}` at 2 samples of delay and 20 kN/m",
            to.hand(model=model),
            at=(2, 20e3),
        )
        for name, _, model in _MODELS
    ),
]

_HOLDS = [
    _robust(name, f"the hand presses for 120 s, {summary}", to.scenario(seconds=120.0), at=at)
    for name, summary, at in (
        ("hold-K20", "20 kN/m", (1, 20e3)),
        ("hold-d2K20", "2 samples of delay and 20 kN/m", (2, 20e3)),
        ("hold-K35", "35 kN/m", (1, 35e3)),
        ("hold-d2K35", "2 samples of delay and 35 kN/m", (2, 35e3)),
    )
]

_HELD = [
    _robust("hold-10min", "no hands: one of 0.05 kg, 20 N s/m, 1000 N/m moves 30 mm in 3 s and holds for 10 min",
            drives=[to.held(600.0)]),
    _robust("hold-1h", "no hands: the one of hold-10min holds for an hour", drives=[to.held(3600.0)]),
]  # fmt: skip

#: Every condition by its name.
CONDITIONS: dict[str, Condition] = {
    c.name: c
    for c in (
        AS_GIVEN,
        *_FIVE,
        *_CELLS,
        *_ROBUSTNESS,
        *_FAILING,
        *_HANDS,
        *_DAMPED,
        *_HOLDS,
        *_HELD,
    )
}

#: Groups of conditions: the names they stand for.
GROUPS: dict[str, tuple[str, ...]] = {
    "five": tuple(c.name for c in _FIVE),
    "cells": tuple(
        "d1b1K5" if (d, b, k) == (1, 1, 5) else f"d{d}b{b}K{k}"
        for d in (0, 1, 2) for b in (1, 2, 4) for k in (2, 5, 10, 20)
    ),
    "robustness": tuple(c.name for c in _ROBUSTNESS),
    "failures": (*(c.name for c in _FAILING), *_TOLD, *_OTHER),
    "hands": tuple(c.name for c in _HANDS),
    "damped-walls": tuple(c.name for c in _DAMPED),
    "holds": ("hold", *(c.name for c in _HOLDS)),
    "all": tuple(CONDITIONS),
}  # fmt: skip


def conditions(names: Iterable[str | Condition]) -> list[Condition]:
    """Return conditions by name or group, each once, in the order asked; a Condition stands for itself.

    A name such as d2b1K15 that is none of `CONDITIONS` is understood, too: see `written_out`. Without b1 the
    device keeps its damping; K15 changes the stiffness of the wall to 15 kN/m and leaves delay and device as they are.
    A condition has the name by which it was first asked for.

    Parameters
    ----------
    names : str, Condition, or several
        Names of `CONDITIONS` or `GROUPS`, or conditions.

    Raises
    ------
    ValueError
        For an unknown name; suggests the nearest.
    """
    found: dict[str, Condition] = {}
    require(names, Iterable, "ebac.study", "conditions by name")
    given = [names] if isinstance(names, str) else list(names)
    taken = {*GROUPS, *(one.name for one in given if isinstance(one, Condition))}
    for name in given:
        require(name, (str, Condition), "ebac.study", "conditions by name")
        if isinstance(name, Condition):
            found[name.name] = name
            continue
        for one in _named(name):
            found.setdefault(one.name, one if name in taken else replace(one, name=name))
    return list(found.values())


def _named(name: str) -> list[Condition]:
    """Return the conditions that a name stands for."""
    if name in GROUPS:
        return [CONDITIONS[one] for one in GROUPS[name]]
    known = CONDITIONS.get(name)
    if known is not None:
        return [known]
    numbers = written_out(name)
    if numbers is None:
        near = unknown(f"condition {name}", name, [*GROUPS, *CONDITIONS], "condition")
        raise ValueError(f"{near}; {GRAMMAR}")
    if numbers.name in CONDITIONS:
        return [CONDITIONS[numbers.name]]
    if numbers.delay is None:
        return [wall_of(1e3 * numbers.kilo)]
    return [cell_of(numbers.name, numbers.delay, numbers.damping, numbers.kilo)]
