"""A scenario as the WebAssembly module takes it: settings by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ebac._core import BackwardDifference, Linear, Observer, Step, Wall
from ebac._util import serialisation
from ebac.scenario import Scenario
from ebac.scenario_checks import EVERY_LAW, LEARNS_SCALE

#: Parts whose numbers are settings, by the names of a scenario's TOML file.
_PARTS = ("device", "hand", "environment", "timing")


def settings(scenario: Scenario) -> dict[str, float]:
    """Return what a scenario has other than `Scenario()`: "hand.mass" and so on, in SI units.

    Raises
    ------
    TypeError
        For what the module does not simulate: another world than a wall, several axes, a model of a hand, a path
        other than a step, a velocity estimator other than the difference.
    """
    device, hand = scenario.device, scenario.hand
    for name, part, kind in (
        ("environment", scenario.environment, Wall),
        ("device.kinematics", device.kinematics, Linear),
        ("device.velocity", device.velocity, BackwardDifference),
        ("hand.path[0]", hand.path[0], Step),
        ("hand.model", hand.model, type(None)),
    ):
        if not isinstance(part, kind):
            wanted = "None" if kind is type(None) else f"a {kind.__name__}"
            raise TypeError(
                f"ebac.live: {name} is a {type(part).__name__}: must be {wanted}; use ebac.explore.sliders or "
                "ebac.simulate"
            )
    if device.axes != 1:
        raise TypeError(f"ebac.live: the device has {device.axes} axes: must have 1")
    if isinstance(scenario.observer, Observer):
        raise TypeError("ebac.live: observer is an Observer: must be True, False or a name")
    usual = dict(_numbers(Scenario()))
    return {name: value for name, value in _numbers(scenario) if value != usual[name]}


def options(scenario: Scenario) -> dict[str, float]:
    """Return observer (0 off, 1 on, 2 for every law, 3 with the scale learned), seed and jitter.

    Raises
    ------
    ValueError
        For a seed that is no whole number of JavaScript.
    """
    if scenario.seed > 2**53:
        raise ValueError(f"Scenario.seed = {scenario.seed}: must lie in [0, 2^53] for a browser")
    named = {EVERY_LAW: 2, LEARNS_SCALE: 3}
    chosen = scenario.observer
    observer = named[chosen] if isinstance(chosen, str) else int(bool(chosen))
    return {"observer": observer, "seed": scenario.seed, "jitter": scenario.jitter}


def _numbers(scenario: Scenario) -> Iterator[tuple[str, float]]:
    for part in _PARTS:
        yield from _flat(part, serialisation.to_document(getattr(scenario, part)))


def _flat(name: str, item: Any) -> Iterator[tuple[str, float]]:
    if isinstance(item, Mapping):
        for key, part in item.items():
            yield from _flat(f"{name}.{key}", part)
    elif isinstance(item, list):  # paths: one axis
        yield from _flat(name, item[0])
    elif isinstance(item, (int, float)):
        yield name, float(item)
