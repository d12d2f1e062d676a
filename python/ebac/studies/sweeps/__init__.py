"""Many runs in one call: metrics instead of traces, over threads, processes or machines."""

from ebac.sweeps.result import SweepResult
from ebac.sweeps.run import SweepInterrupted, sweep

__all__ = ["SweepInterrupted", "SweepResult", "sweep"]
