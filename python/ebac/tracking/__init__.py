"""How well a device follows a line and a circle: fits, their uncertainty, and an error budget (paper, Table I)."""

from ebac.tracking.budget import Budget, BudgetRow, error_budget
from ebac.tracking.circle import CircleFit, fit_circle
from ebac.tracking.deviation import Deviation
from ebac.tracking.error_sources import ErrorSources
from ebac.tracking.evaluate import Tracking, evaluate
from ebac.tracking.line import LineFit, fit_line
from ebac.tracking.read import RecordedPath, read_path
from ebac.tracking.table import TABLE_I, TableEntry

__all__ = [
    "TABLE_I",
    "Budget",
    "BudgetRow",
    "CircleFit",
    "Deviation",
    "ErrorSources",
    "LineFit",
    "RecordedPath",
    "TableEntry",
    "Tracking",
    "error_budget",
    "evaluate",
    "fit_circle",
    "fit_line",
    "read_path",
]


def __dir__() -> list[str]:
    return __all__
