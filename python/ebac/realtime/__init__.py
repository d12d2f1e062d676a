"""What the machine can do for a loop, and how to get the rest."""

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
