"""Stability maps: one law over a grid of two quantities."""

from ebac.maps.axes import AXES, PRESETS, MapAxis
from ebac.maps.grid import stability_map
from ebac.maps.result import VERDICTS, StabilityMap

__all__ = ["AXES", "PRESETS", "VERDICTS", "MapAxis", "StabilityMap", "stability_map"]
