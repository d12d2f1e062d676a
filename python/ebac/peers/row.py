"""One line of a comparison, and what all peers share."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import asdict, dataclass
from time import perf_counter
from typing import Any

import numpy as np

from ebac._util.arrays import Values
from ebac.scenario import Scenario


@dataclass(frozen=True, kw_only=True)
class PeerRow:
    """A quantity measured, SI units.

    Attributes
    ----------
    subject, program : str
        What was measured, and whose it is.
    value, unit
        How much.
    times_ebac : float or None
        How many times that of ebac in the same subject and run.
    target : str
        The goal; empty for none.
    note : str
        What the program did and did not do for it.
    """

    subject: str
    program: str
    value: float
    unit: str
    times_ebac: float | None = None
    target: str = ""
    note: str = ""

    def row(self) -> dict[str, Any]:
        """Return it as a plain row."""
        return asdict(self)


@dataclass(frozen=True, kw_only=True)
class Plant:
    """Hand and device as one mass, spring and damper, pulled to a target.

    Attributes
    ----------
    mass, damping, stiffness, target : float
        kg, N s/m, N/m, m.
    wall : float
        Stiffness of the wall at 0 m [N/m].
    lag : float
        Of the current loop [s].
    step : float
        s.
    """

    mass: float
    damping: float
    stiffness: float
    target: float
    wall: float
    lag: float
    step: float

    @classmethod
    def of(cls, scenario: Scenario) -> Plant:
        """Return the plant of a scenario with a step path and a wall."""
        device, hand, wall = scenario.device, scenario.hand, scenario.environment
        return cls(
            mass=device.mass + hand.mass,
            damping=device.mechanics.damping + hand.damping,
            stiffness=hand.stiffness,
            target=getattr(hand.path[0], "target", 0.0),
            wall=getattr(wall, "stiffness", 0.0),
            lag=device.drive.current_lag,
            step=scenario.timing.dt,
        )

    def free(self, t: Values) -> Values:
        """Return the position [m] in free motion from rest at 0, in closed form."""
        matrix = np.array([[0.0, 1.0], [-self.stiffness / self.mass, -self.damping / self.mass]])
        rates, modes = np.linalg.eig(matrix.astype(complex))
        share = np.linalg.solve(modes, np.array([-self.target, 0.0], complex))
        return np.asarray(self.target + (np.exp(np.outer(t, rates)) @ (modes[0] * share)).real)


def program(name: str) -> Any:
    """Return a module of an optional program.

    Parameters
    ----------
    name : str
        Of the module, with dots.

    Raises
    ------
    ImportError
        When it is not installed; the message contains how to install it.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(
            f"the comparison needs {name.partition('.')[0]}: pip install 'ebac[peers]'"
        ) from error


def quickest(repeats: int, work: Callable[[], Any]) -> float:
    """Return the shortest time of several calls [s], since noise only adds."""
    best = float("inf")
    for _ in range(repeats):
        start = perf_counter()
        work()
        best = min(best, perf_counter() - start)
    return best
