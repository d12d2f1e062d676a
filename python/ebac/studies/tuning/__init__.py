"""Laws at their best: parameters searched on training hands, judged on others."""

from ebac.studies.tuning.cost import cost_of
from ebac.studies.tuning.ranges import RANGES
from ebac.studies.tuning.result import Tuned, TunedRow, TuningInterrupted
from ebac.studies.tuning.run import HANDS, HANDS_SEED, TUNING_CONDITIONS, tune

__all__ = [
    "HANDS",
    "HANDS_SEED",
    "RANGES",
    "TUNING_CONDITIONS",
    "Tuned",
    "TunedRow",
    "TuningInterrupted",
    "cost_of",
    "tune",
]


def __dir__() -> list[str]:
    return __all__
