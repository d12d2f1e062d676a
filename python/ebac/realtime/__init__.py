"""Check a machine for real-time problems, and measure how late a thread wakes."""

from ebac._core import Grant, RealTime, RealTimeMode
from ebac.realtime.doctor import Finding, examine
from ebac.realtime.jitter import Cyclictest, Jitter, beside_cyclictest, cyclictest, measure

__all__ = [
    "Cyclictest",
    "Finding",
    "Grant",
    "Jitter",
    "RealTime",
    "RealTimeMode",
    "beside_cyclictest",
    "cyclictest",
    "examine",
    "measure",
]


def __dir__() -> list[str]:
    return __all__
