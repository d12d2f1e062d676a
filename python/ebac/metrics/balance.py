"""Where a force that falls with the way is zero."""

from __future__ import annotations

from collections.abc import Callable


def balance(left: Callable[[float], float], low: float, high: float) -> float | None:
    """Return where `left`, a falling force [N], is zero between two places [m], by bisection; None where it is not."""
    if not left(low) > 0 > left(high):  # NaN too: a hand that never rests, or is not known
        return None
    while True:
        middle = (low + high) / 2
        if middle in (low, high):
            return middle
        low, high = (middle, high) if left(middle) > 0 else (low, middle)
