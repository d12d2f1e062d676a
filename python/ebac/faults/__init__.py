"""Fault injection: thousands of runs in which something goes wrong, each judged. All of it is simulation."""

from ebac.faults.faults import (
    FaultCampaign,
    FaultCase,
    FaultRow,
    kinds,
    run_campaign,
    run_case,
)

__all__ = [
    "FaultCampaign",
    "FaultCase",
    "FaultRow",
    "kinds",
    "run_campaign",
    "run_case",
]


def __dir__() -> list[str]:
    return __all__
