"""Many runs in one call: metrics instead of traces, over threads, processes or machines."""

from ebac.studies.sweeps.result import SweepResult
from ebac.studies.sweeps.run import SweepInterrupted, sweep

__all__ = ["SweepInterrupted", "SweepResult", "sweep"]


def __dir__() -> list[str]:
    return __all__
