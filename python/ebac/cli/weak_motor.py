"""What the motor of a device cannot give: a sentence for one hand, a note for many."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.operators import Operators
    from ebac.scenario import Scenario

#: A rest that needs so many times the continuous force: the winding is as hot as it may be after one time constant.
WARM = 1.25


def sentence(scenario: Scenario) -> str:
    """Return what the motor cannot give at the ideal rest, or not for long; else nothing."""
    force, device = _at_rest(scenario), scenario.device
    needs = f"the ideal rest needs {force:.3g} N, and the motor"
    if force > device.peak_force:
        return f"No law can be exact: {needs} gives {device.peak_force:.3g} N at most."
    if force > WARM * device.continuous_force:
        return (
            f"Too hot to be held: {needs} gives {device.continuous_force:.3g} N for ever (rated_torque). Its heat is "
            "not simulated; `ebac run` limits it."
        )
    return ""


def tell(population: Operators, base: Scenario) -> None:
    """Say on stderr for how many hands the motor is too weak at their ideal rest."""
    most = base.device.peak_force
    weak = sum(_at_rest(scenario) > most for scenario in population.scenarios(base))
    if weak:
        output.note(
            f"{weak} of the {len(population)} hands press with more than the motor can give, {most:.3g} N "
            "(device.motor.rated_torque, device.drive.peak_ratio): no law can be exact for them"
        )


def _at_rest(scenario: Scenario) -> float:
    """Return the force at the ideal rest [N]; 0 where there is none."""
    from ebac.metrics.ideal import ideal_rest

    ideal = ideal_rest(scenario)
    return 0.0 if ideal is None else abs(scenario.hand.steady(ideal))
