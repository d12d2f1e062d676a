"""Stability maps: one law over a grid of two quantities."""

from ebac.studies.maps.axes import AXES, PRESETS, MapAxis
from ebac.studies.maps.grid import stability_map
from ebac.studies.maps.result import VERDICTS, StabilityMap

__all__ = ["AXES", "PRESETS", "VERDICTS", "MapAxis", "StabilityMap", "stability_map"]


def __dir__() -> list[str]:
    return __all__
