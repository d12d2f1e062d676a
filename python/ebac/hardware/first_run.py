"""The first run of a device: in free air, with small limits."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ebac._core import Free, Limits
from ebac._util.descriptions import described_environment
from ebac.laws.making import FORCE_GAINS

if TYPE_CHECKING:
    from ebac.hardware.configuration import Configuration

#: Largest current of each motor [A], at any time and for ever, and largest speed of the handle [m/s].
MOST = {"peak_current": 0.1, "continuous_current": 0.1, "speed": 1.0}


def changed_parts(known: Configuration) -> dict[str, Any]:
    """Return the parts of a configuration that differ in its first run."""
    law = known.design()
    gains = {name: 0.0 for name in FORCE_GAINS if getattr(law, name, 0.0)}
    limits = {name: min(most, getattr(known.limits, name)) for name, most in MOST.items()}
    return {
        "environment": Free(),
        "engine": "",
        "changes": {**known.changes, **gains},
        "limits": known.limits.replace(**limits),
    }


def differences(known: Configuration, first: Configuration) -> Iterator[str]:
    """Yield a line for each value of a configuration that differs in its first run."""
    if known.engine:
        yield f"environment: free air instead of the engine, {known.engine}"
    elif known.environment != first.environment:
        yield f"environment: free air instead of {described_environment(known.environment)}"
    before, after = known.design(), first.design()
    for name in FORCE_GAINS:
        if (gain := getattr(before, name, 0.0)) != getattr(after, name, 0.0):
            yield f"law.{name}: 0 instead of {gain:.4g}, so that the law feeds no force back"
    units = {one.name: one.unit for one in Limits.fields()}
    for name in MOST:
        was, now = getattr(known.limits, name), getattr(first.limits, name)
        if was != now:
            force = (
                f" ({first.device.force(now):.3g} N at the handle)" if units[name] == "A" else ""
            )
            yield f"limits.{name}: {now:g} {units[name]}{force} instead of {was:.4g} {units[name]}"
