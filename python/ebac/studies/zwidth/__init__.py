"""Z-width (Colgate and Brown 1994): which walls a device can render, and how far each law moves that border.

`spectral_radius`, `eigenvalues` and `stiffness_limit` are exact for the sampled linear loop; the ceilings are formulas;
`zwidth` searches the border in the simulation of laws.
"""

from ebac.studies.zwidth.ceilings import delay_ceiling, passive_ceiling, quantised_ceiling
from ebac.studies.zwidth.linear import eigenvalues, spectral_radius, stiffness_limit
from ebac.studies.zwidth.result import CRITERIA, ZWidth
from ebac.studies.zwidth.search import zwidth

__all__ = [
    "CRITERIA",
    "ZWidth",
    "delay_ceiling",
    "eigenvalues",
    "passive_ceiling",
    "quantised_ceiling",
    "spectral_radius",
    "stiffness_limit",
    "zwidth",
]


def __dir__() -> list[str]:
    return __all__
