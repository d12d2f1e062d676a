"""Measure a contact with a wall, the use of the observer, and what held the current back, from a trace alone."""

from ebac.metrics.contact_result import Contact
from ebac.metrics.current_limits import CurrentLimits, current_limits
from ebac.metrics.energy_drawn import drawn, work_of_surfaces
from ebac.metrics.ideal import EXACT_COUNTS, allowed_deviation, ideal_rest
from ebac.metrics.observer import ObserverUse, observer_use
from ebac.metrics.wall_contact import FEWEST_ROWS, STILL_SWING, TAIL_SHARE, contact
from ebac.metrics.world_contact import WorldContact, world_contact

__all__ = [
    "EXACT_COUNTS",
    "FEWEST_ROWS",
    "STILL_SWING",
    "TAIL_SHARE",
    "Contact",
    "CurrentLimits",
    "ObserverUse",
    "WorldContact",
    "allowed_deviation",
    "contact",
    "current_limits",
    "drawn",
    "ideal_rest",
    "observer_use",
    "work_of_surfaces",
    "world_contact",
]


def __dir__() -> list[str]:
    return __all__
