"""A trace: named columns with units, one row per tick."""

from ebac.trace.columns import ColumnInfo
from ebac.trace.trace import Trace

__all__ = ["ColumnInfo", "Trace"]


def __dir__() -> list[str]:
    return __all__
