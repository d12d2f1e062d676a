"""The scale of a force sensor against that of the motor, from a hand that presses on a wall to and fro."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number
from ebac._util.arrays import Values
from ebac._util.wrong_calls import plain_function
from ebac.identify.intervals import Z95, newey_west
from ebac.identify.missing import left_for
from ebac.identify.recording import Recording
from ebac.identify.recording_list import require_recordings
from ebac.identify.signals import stair

#: Half of the time over which motion and forces are compared [s].
HALF = 0.064
#: It slides one way if it does so in every sixth of one and a half intervals, by a count and as fast [m/s] at least.
SIXTHS, SLOWEST = 6, 0.5e-3
#: Motion is slow if mass times acceleration is below this share of the hand's force, plus this force [N].
SLOW, SLOW_N = 0.2, 0.1
#: Fewer comparisons say nothing.
LEAST = 30
#: Deviations to which mass and damping are taken to be known, as shares.
MASS, DAMPING = 0.1, 0.2
#: The interval reaches at least so far to either side: at a stiff wall few counts show which way it slides.
FLOOR = 0.001
#: The scale is determined if its interval is at most so wide on either side.
DETERMINED = 0.005


@dataclass(frozen=True, kw_only=True)
class ForceScale:
    """What a force sensor shows of a force, over what the motor gives for it.

    Attributes
    ----------
    scale, low, high : float
        The reading of the sensor for 1 N of the motor [N/N], with its 95 % interval; 1 where both agree.
    friction : float
        Coulomb friction of the device [N].
    offset : float
        Reading of the sensor without any force, and weight of the handle [N].
    left : float
        Standard deviation of what the forces leave unexplained [N].
    comparisons : int
        Intervals of 0.13 s that were compared, each in slow motion one way.
    determined : bool
        Whether the interval reaches at most 0.5 % to either side.
    """

    scale: float
    low: float
    high: float
    friction: float
    offset: float
    left: float
    comparisons: int
    determined: bool

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers in SI units, for JSON."""
        return {
            "scale_N_per_N": self.scale,
            "scale_low_N_per_N": self.low,
            "scale_high_N_per_N": self.high,
            "friction_N": self.friction,
            "offset_N": self.offset,
            "left_N": self.left,
            "comparisons": self.comparisons,
            "determined": self.determined,
        }

    def __str__(self) -> str:
        """Return "1 N of the motor reads 0.980 N (0.979 to 0.981)"."""
        loose = "" if self.determined else ", NOT DETERMINED by this log"
        return (
            f"1 N of the motor reads {self.scale:.4f} N ({self.low:.4f} to {self.high:.4f}{loose})"
        )


@plain_function
def force_scale(
    recording: Recording, *, mass: float | None = None, damping: float | None = None
) -> ForceScale:
    """Compare the scale of the force sensor with that of the motor.

    In slow motion the forces on the handle nearly cancel: M a = F/s - B v - f_c sign(v) - F_m + w. With mass M and
    damping B known, that is linear in the scale s of the reading F, in friction f_c and in a constant w. Positions and
    forces are compared over 0.13 s, with the weight of a triangle: the second difference of the position is then the
    mean acceleration. Only intervals count in which the device slides one way and accelerates little. Which of the two
    scales is wrong the log does not show.

    Parameters
    ----------
    recording : Recording
        Position, force of the hand and force of the motor, of a hand that presses on a wall to and fro for 10 s or
        more: by 5 to 20 N, about once a second, on 1 to 3 kN/m.
    mass : float, optional
        Mass of the device at the handle [kg], 0.001 to 100; taken to be known to 10 %. Default: that of the scenario
        in the log.
    damping : float, optional
        Viscous damping of the device [N s/m], 0 to 500; taken to be known to 20 %. Default: as above.

    Returns
    -------
    ForceScale
        The scale with its 95 % interval, friction, and offset.

    Raises
    ------
    TypeError
        For something that is no recording or no number.
    ValueError
        For a recording without one of the forces, of a knob or joint, without mass or damping, with one that is out of
        range, or with too little slow motion in both directions.
    """
    require_recordings(recording, "force_scale")
    r = recording
    for name in ("force", "motor"):
        if getattr(r, name) is None:
            whose = "hand" if name == "force" else "motor"
            raise ValueError(f"{r.name}: lacks the force of the {whose}{left_for(name, r)}")
    M = _known(r, "mass", "kg", mass, r.mass, (1e-3, 100.0))
    B = _known(r, "damping", "N s/m", damping, r.damping, (0.0, 500.0))
    rows = np.concatenate([_compared(r.rows(part)) for part in r.stretches])
    hand, motor, a, v, way = rows.T
    slow = (way != 0) & (np.abs(M * a) < SLOW * np.abs(hand) + SLOW_N)
    hand, motor, a, v, way = rows[slow].T
    if len(hand) < LEAST or not ((way > 0).any() and (way < 0).any()):
        raise ValueError(
            f"{r.name}: moves slowly one way in {len(hand)} intervals of {2 * HALF:.2g} s only; needs {LEAST}, in both "
            "directions. Press on a wall of 1 to 3 kN/m to and fro, by 5 to 20 N, about once a second, for 15 s"
        )
    left = np.linalg.pinv(np.column_stack([hand, -way, np.ones(len(hand))]))
    y = motor + M * a + B * v
    per_reading, friction, constant = left @ y
    errors = y - per_reading * hand + friction * way - constant
    spread = newey_west(left * errors)[0, 0] * len(y) / (len(y) - 3)
    of_facts = (MASS * M * left[0] @ a) ** 2 + (DAMPING * B * left[0] @ v) ** 2
    scale = 1 / per_reading
    half = float(np.hypot(Z95 * np.sqrt(spread + of_facts) * scale**2, FLOOR))
    return ForceScale(
        scale=float(scale),
        low=float(scale - half),
        high=float(scale + half),
        friction=float(friction),
        offset=float(-constant * scale),
        left=float(np.std(errors)),
        comparisons=len(y),
        determined=bool(half <= DETERMINED),
    )


def _known(
    r: Recording,
    name: str,
    unit: str,
    given: float | None,
    of_log: float | None,
    within: tuple[float, float],
) -> float:
    """Return what is given, or what the log has.

    Raises
    ------
    ValueError
        For neither, or one out of range.
    """
    value = of_log if given is None else number(f"force_scale: {name}", given)
    if value is None:
        raise ValueError(
            f"{r.name}: has no scenario with mass and damping of the device; give both, --mass KG --damping N_S_PER_M "
            "or mass=..., damping=... [kg, N s/m]"
        )
    low, high = within
    if not low <= value <= high:
        raise ValueError(f"{name} = {value:g} {unit}: must lie in [{low:g}, {high:g}] {unit}")
    return value


def _compared(r: Recording) -> NDArray[np.float64]:
    """Return, for each interval of a stretch, force of hand and motor [N], acceleration, velocity, and the direction.

    The direction is 1 or -1 where the device slides one way all through the interval and half of one on either side,
    else 0.
    """
    assert r.force is not None
    assert r.motor is not None
    n = max(2, round(HALF / r.dt))
    around = n + n // 2
    if len(r.x) <= 2 * around + 1:
        return np.zeros((0, 5))
    weight = np.concatenate([np.arange(1, n + 1), np.arange(n - 1, 0, -1)]) / n**2
    at = np.arange(around, len(r.x) - around, max(1, n // 2))

    def mean(values: Values) -> Values:
        return np.convolve(values, weight, mode="valid")[at - n + 1]

    edges = np.linspace(-around, around, SIXTHS + 1).astype(int)
    ways = np.diff(r.x[at[:, None] + edges], axis=1)
    least = max(r.count, SLOWEST * 2 * around * r.dt / SIXTHS) * (1 - 1e-6)
    up, down = ((sign * ways >= least).all(axis=1) for sign in (1, -1))
    shown, _ = stair(r.motor, r.dt, r.current_lag, r.lag)
    return np.column_stack(
        [
            mean(r.force),
            mean(shown),
            (r.x[at + n] - 2 * r.x[at] + r.x[at - n]) / (n * r.dt) ** 2,
            (r.x[at + n] - r.x[at - n]) / (2 * n * r.dt),
            up.astype(float) - down,
        ]
    )
