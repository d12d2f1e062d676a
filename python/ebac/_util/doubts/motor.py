"""What the motor of a device cannot give at rest: to one hand, or to some of many."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.operators import Operators
    from ebac.scenario import Scenario

#: A rest that needs so many times the continuous force: the winding is as hot as it may be after one time constant.
WARM = 1.25


def too_weak(scenario: Scenario) -> str:
    """Return what the motor cannot give at the ideal rest; else nothing."""
    force, most = _at_rest(scenario), scenario.device.peak_force
    return (
        f"No law can be exact: {_needs(force)} gives {most:.3g} N at most" if force > most else ""
    )


def too_hot(scenario: Scenario) -> str:
    """Return what the motor cannot give for long at the ideal rest; else nothing."""
    force, device = _at_rest(scenario), scenario.device
    if not WARM * device.continuous_force < force <= device.peak_force:
        return ""
    return (
        f"Too hot to be held: {_needs(force)} gives {device.continuous_force:.3g} N for ever (rated_torque); its heat "
        "is not simulated, `ebac run` limits it"
    )


def _needs(force: float) -> str:
    return f"the ideal rest needs {force:.3g} N, and the motor"


def of_many(population: Operators, base: Scenario) -> str:
    """Return for how many hands the motor is too weak at their ideal rest; nothing where it is for none."""
    if not (weak := _weak(population, base)):
        return ""
    return (
        f"{weak} of the {len(population)} hands press with more than the motor can give, "
        f"{_given(base)}: no law can be exact for them"
    )


def of_walls(population: Operators, base: Scenario, stiffnesses: Iterable[float]) -> str:
    """Return from which wall [N/m] on the motor is too weak for hands, as on a stiffer one they press harder."""
    from ebac._core import Wall

    wall = base.environment
    if not isinstance(wall, Wall):
        return ""
    walls = {one: base.replace(environment=wall.replace(stiffness=one)) for one in stiffnesses}
    weak = {one: _weak(population, at) for one, at in sorted(walls.items())}
    first, last = next((one for one, count in weak.items() if count), None), max(weak, default=0.0)
    if first is None:
        return ""
    harder = "" if weak[first] == weak[last] else f", for {weak[last]} at {last / 1e3:g} kN/m"
    softer = "" if first == min(weak) else "; this does not concern softer walls"
    return (
        f"at a wall of {first / 1e3:g} kN/m{'' if first == last else ' and stiffer'}, hands press with more than the "
        f"motor can give, {_given(base)}: no law can be exact for {weak[first]} of the {len(population)} hands "
        f"there{harder}{softer}"
    )


def _weak(population: Operators, base: Scenario) -> int:
    """Return for how many hands the motor is too weak at their ideal rest."""
    most = base.device.peak_force
    return sum(_at_rest(scenario) > most for scenario in population.scenarios(base))


def _given(base: Scenario) -> str:
    """Return the largest force of the motor, and where it comes from."""
    return f"{base.device.peak_force:.3g} N (device.motor.rated_torque, device.drive.peak_ratio)"


def _at_rest(scenario: Scenario) -> float:
    """Return the force at the ideal rest [N]; 0 where there is none."""
    from ebac.metrics.ideal import ideal_rest

    ideal = ideal_rest(scenario)
    return 0.0 if ideal is None else abs(scenario.hand.steady(ideal))
