"""Counts of a force sensor that are possible, but more likely in a wrong unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.sensor import SensorConfig

#: Coarsest step of a force that a sensor for a hand has [N], and of a torque [N m].
COARSEST = {"counts_per_force": (0.25, "N"), "counts_per_torque": (0.025, "N m")}


def doubts(sensor: SensorConfig) -> list[str]:
    """Return a sentence for each scale that is likely wrong: its value, what is usual, and where to look."""
    found = []
    for name, (coarsest, unit) in COARSEST.items():
        step = 1 / getattr(sensor, name)
        if step > coarsest:
            found.append(
                f"sensor.{name} = {getattr(sensor, name):g} counts/({unit}): a step of {step:g} {unit}, usual are at "
                f"most {coarsest:g} {unit}; `ebac sensor read --page` shows the counts of the sensor"
            )
    return found
