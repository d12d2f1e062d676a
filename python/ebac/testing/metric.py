"""What a run comes to, beside what it came to when its golden trace was written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ebac._util import formatting
from ebac._util.arguments import number
from ebac.metrics import Contact

Metrics = dict[str, str | float | None]


@dataclass(frozen=True)
class _Metric:
    """Unit of a metric, how far it may move, and which way is worse: +1 larger, -1 smaller, 0 either."""

    unit: str
    allowed: float
    worse: int


#: The metrics of a contact that are stored; one that rounding can move has room to move.
METRICS = {
    "rest_m": _Metric("m", 1e-5, 0),
    "deviation_m": _Metric("m", 1e-5, +1),
    "swing_m": _Metric("m", 1e-5, +1),
    "force_swing_N": _Metric("N", 0.1, +1),
    "settled_s": _Metric("s", 0.01, +1),
    "peak_m": _Metric("m", 1e-5, +1),
    "limit_cycle_Hz": _Metric("Hz", 0.5, 0),
    "least_energy_J": _Metric("J", 1e-6, -1),
    "clamped_share": _Metric("share", 0.01, +1),
    "force_step_N": _Metric("N", 0.1, +1),
}


def metrics_of(contact: Contact) -> Metrics:
    """Return the metrics of a contact that stand beside a golden trace."""
    return {"law": contact.law, **{name: getattr(contact, name) for name in METRICS}}


def check_names(tolerances: Mapping[str, float]) -> None:
    """Refuse a tolerance for what is no metric, or that is negative."""
    for name, allowed in tolerances.items():
        if name not in METRICS:
            raise ValueError(f"metric {name!r}: there are {', '.join(METRICS)}")
        if not number(f"tolerance of {name}", allowed) >= 0:
            raise ValueError(f"tolerance of {name} = {allowed}: must not be negative")


def differences(found: Metrics, golden: Metrics, tolerances: Mapping[str, float]) -> list[str]:
    """Return a line for each metric that moved by more than it may."""
    lines = []
    for name, metric in METRICS.items():
        if name not in golden:
            continue
        value, wanted = found.get(name), golden[name]
        allowed = tolerances.get(name, metric.allowed)
        shown, unit = [_shown(v, metric.unit) for v in (value, wanted, allowed)], metric.unit
        if isinstance(value, (int, float)) and isinstance(wanted, (int, float)):
            if abs(value - wanted) <= allowed:
                continue
            moved = formatting.quantity(value - wanted, unit, signed=True)
            farther = abs(value) - abs(wanted) if name == "deviation_m" else value - wanted
            lines.append(
                f"{name}: {shown[0]}, golden {shown[1]}: {_way(farther, metric)} by {moved}, "
                f"allowed +-{shown[2]}"
            )
        elif value != wanted:
            lines.append(f"{name}: {shown[0]}, golden {shown[1]}")
    return lines


def _way(moved: float, metric: _Metric) -> str:
    if metric.worse == 0:
        return "moved"
    return "worse" if moved * metric.worse > 0 else "better"


def _shown(value: str | float | None, unit: str) -> str:
    return value if isinstance(value, str) else formatting.quantity(value, unit, none="none")
