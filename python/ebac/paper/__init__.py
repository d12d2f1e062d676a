"""The numbers and figures of the paper, recomputed and compared with the published ones.

`find("eq1")` returns one finding, `report("report/", ITEMS)` writes them all. Everything here is
computed or simulated; nothing was measured on a device.
"""

from ebac.paper.finding import Finding, Verdict
from ebac.paper.items import ITEMS, find
from ebac.paper.report import report

__all__ = ["ITEMS", "Finding", "Verdict", "find", "report"]


def __dir__() -> list[str]:
    return __all__
