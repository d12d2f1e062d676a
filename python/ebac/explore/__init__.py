"""Long traces in a notebook: zoomable, linked panels that stay fluid over a million rows and lose no peak."""

from ebac.explore.exploration import Exploration, explore

__all__ = ["Exploration", "explore"]


def __dir__() -> list[str]:
    return __all__
