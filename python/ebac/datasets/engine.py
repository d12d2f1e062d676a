"""A virtual world as a program of its own: a ball of 2 kN/m that breathes, 500 times a second.

`ebac run joystick.toml --simulated --engine-command "python engine.py"` starts it, and ends it with the run.
No device was ever run with it.
"""

from __future__ import annotations

import math
import time
from typing import Any

from ebac.worlds import LocalModel, serve_engine

RADIUS, CENTRE, STIFFNESS = 0.03, (0.04, 0.0, 0.0), 2000.0  # m, m, N/m
BREATH, RATE = 0.002, 0.25  # m, Hz


def ball(x: Any, v: Any) -> LocalModel | None:
    """Return the ball near a handle at x [m] with velocity v [m/s], each of shape (3,)."""
    phase = 2 * math.pi * RATE * time.monotonic()
    radius = RADIUS + BREATH * math.sin(phase)
    speed = 2 * math.pi * RATE * BREATH * math.cos(phase)
    towards = [c - p for c, p in zip(CENTRE, x, strict=True)]
    far = math.hypot(*towards)
    if far == 0:
        return None
    a, b, c = (one / far for one in towards)
    i, j, k = CENTRE
    return LocalModel(
        at=(i - radius * a, j - radius * b, k - radius * c),
        normal=(a, b, c),
        stiffness=STIFFNESS,
        radius=radius,
        velocity=(-speed * a, -speed * b, -speed * c),
    )


if __name__ == "__main__":
    serve_engine(ball, rate=500)
