"""A law written in Python, in the same loop as those of the core: slow, and good for a first idea.

`pytest 02_law_in_python.py` runs the contract of every law on it; that needs pytest and hypothesis.
"""

from dataclasses import dataclass

import ebac
from ebac.testing import LawContract


@dataclass
class Damped:
    """The world's force plus a virtual damper [N s/m] while in contact."""

    damping: float = 33.0
    name = "damped"

    def reset(self) -> None:
        """Nothing is remembered."""

    def step(self, port: ebac.Port) -> float:
        """Return the force for one tick of one axis [N]."""
        return port.f_env + self.damping * port.v if port.f_env > 0 else 0.0


class TestDamped(LawContract):
    law = Damped


if __name__ == "__main__":
    scenario = ebac.Scenario()
    for law in ("tca", Damped(), "ebac"):
        wall = ebac.contact(ebac.simulate(scenario, law))
        print(
            f"{wall.law:7s} swings {1e3 * wall.swing_m:.3f} mm, rests at {1e3 * wall.rest_m:.3f} mm"
        )
