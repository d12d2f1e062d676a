"""Populations of operators: hands of eq. (4), each with the depth it wants to reach."""

from ebac.operators.operators import MOST_PULL, Operators

__all__ = ["MOST_PULL", "Operators"]


def __dir__() -> list[str]:
    return __all__
