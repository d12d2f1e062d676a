"""Which of its TOML files `ebac` was given, by the tables that only that kind has."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

#: The first kind of which a document has a table.
_KINDS = (
    ("a network file of drives", {"node"}),
    ("a profile of a drive", {"pdo", "torque", "drive", "heartbeat", "emcy", "motor", "without"}),
    (
        "a configuration of `ebac run`",
        {
            "bus",
            "signs",
            "zero",
            "engine",
            "law",
            "limits",
            "run",
            "realtime",
            "recording",
            "sensor",
            "simulated",
        },
    ),
    ("a scenario", {"device", "hand", "environment", "timing", "seconds", "jitter", "seed"}),
)
NETWORK, PROFILE, CONFIGURATION, SCENARIO = (name for name, _ in _KINDS)


def kind_of(table: Mapping[str, Any]) -> str:
    """Return what a document is; "" where no table says so."""
    return next((name for name, own in _KINDS if not own.isdisjoint(table)), "")
