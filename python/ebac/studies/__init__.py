"""Laws over whole populations of hands, under named conditions."""

from ebac.studies.conditions import CONDITIONS, GROUPS, Condition, conditions
from ebac.studies.result import Failure, Study, StudyRow
from ebac.studies.study import study

__all__ = [
    "CONDITIONS",
    "GROUPS",
    "Condition",
    "Failure",
    "Study",
    "StudyRow",
    "conditions",
    "study",
]
