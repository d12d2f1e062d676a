"""In a notebook: long traces in zoomable panels that lose no peak, and sliders over a scenario."""

from ebac.explore.exploration import Exploration, explore
from ebac.explore.sliders import sliders

__all__ = ["Exploration", "explore", "sliders"]


def __dir__() -> list[str]:
    return __all__
