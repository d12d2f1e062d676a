"""A condition of a study: what it changes of a scenario, and from which facts laws are designed under it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ebac._util.arguments import require
from ebac._util.wrong_calls import plain_constructor
from ebac.studies import scenario_changes as to
from ebac.studies.scenario_changes import Belief, Change

if TYPE_CHECKING:
    from ebac._core import Device, DeviceFacts, Timing
    from ebac.operators import Operators
    from ebac.scenario import Scenario


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Condition:
    """Changes for every hand, and the facts the laws are designed from.

    Attributes
    ----------
    name, summary : str
        How it is called, and what it is in a line.
    change : callable
        A scenario with a hand on it in, the scenario to simulate out.
    believed : callable
        That scenario in, the (DeviceFacts, Timing) for which laws are designed out; default: the truth.
    drives : tuple of callable
        Changes that replace the population: one run each instead of one run per hand.
    """

    name: str
    summary: str
    change: Change
    believed: Belief = to.truth
    drives: tuple[Change, ...] = ()

    def scenarios(self, operators: Operators, base: Scenario) -> list[Scenario]:
        """Return what is simulated under this condition.

        Parameters
        ----------
        operators : Operators
            The hands; a condition with `drives` replaces them.
        base : Scenario
            What the condition changes.
        """
        if self.drives:
            return [self.made(drive(self.change(base))) for drive in self.drives]
        return [self.made(self.change(one)) for one in operators.scenarios(base)]

    def made(self, changed: Scenario) -> Scenario:
        """Return a changed scenario with its observer, if it has one, designed from the believed facts."""
        from ebac.scenario import Scenario

        require(changed, Scenario, f"condition {self.name}", "a change that returns a Scenario")
        return to.observer_of(changed, *self.believed(changed))


def known_under(condition: Condition, scenario: Scenario) -> tuple[Device | DeviceFacts, Timing]:
    """Return for what laws are designed: where nothing is mistaken the device itself, whose parts an error can name."""
    believed = condition.believed(scenario)
    return (scenario.device, believed[1]) if believed == to.truth(scenario) else believed


def cell(delay: int, damping: float | None, stiffness: float) -> Change:
    """Set delay [samples], device damping [N s/m] and wall stiffness [N/m]; None leaves the device's damping."""
    own = () if damping is None else (to.device("mechanics", damping=damping),)
    return to.together(to.timing(delay=delay), *own, to.wall(stiffness=stiffness))


def cell_of(name: str, delay: int, damping: float | None, kilo: float) -> Condition:
    """Return the condition of a delay [samples], a damping of the device [N s/m] and a wall [kN/m]."""
    samples = "1 sample" if delay == 1 else f"{delay} samples"
    own = "" if damping is None else f"device damping {damping:g} N s/m, "
    summary = f"{samples} of delay, {own}wall {kilo:g} kN/m"
    return Condition(name=name, summary=summary, change=cell(delay, damping, 1e3 * kilo))


#: Nothing but the hand is changed; a hand on it begins where the population says.
AS_GIVEN = Condition(
    name="as-given",
    summary="delay, device and wall as in the scenario",
    change=to.together(),
)


def wall_of(stiffness: float) -> Condition:
    """Return the condition that changes the stiffness of the wall [N/m] and nothing else."""
    kilo = f"{1e-3 * stiffness:g}"
    return Condition(
        name=f"K{kilo}",
        summary=f"wall {kilo} kN/m, all else as in the scenario",
        change=to.wall(stiffness=stiffness),
    )
