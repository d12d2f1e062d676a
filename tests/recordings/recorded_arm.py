"""Logs of a hand on a device that this project did not simulate: SciPy's linear systems, no line of the product.

A motor or a target of the hand moves both, eq. (4) and (6) without friction:

    M0 a = F - B0 v - K0 (x - X0) for the hand, M_h a = -F - B_h v + F_m for the device

The sum is linear, so it is discretised exactly at 10 kHz and read where a logger would have read it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]

LEVELS = ("clean", "drift", "rough")
#: The motor shakes a held hand by many lines, or by one; the hand follows a path that is known, or goes to and fro
#: while the motor shakes it; or it goes to and fro on its own, which contains nothing about it: whatever the device
#: answers, twice the hand on twice the device would have moved alike.
TASKS = ("multisine", "sine", "path", "tapping", "alone")
FINE = 1e-4  # s
#: The force is read a little before or after the position [s], by another converter.
APART = 3e-5
RATE = 1000.0  # Hz


@dataclass(frozen=True)
class RecordedArm:
    """A log, and what is true of it. `force` is that of the hand on the handle."""

    level: str
    task: str
    t: Values
    x: Values
    force: Values
    count: float
    switches: tuple[float, ...]
    segments: tuple[int, ...]
    path: Values | None
    truth: dict[str, float]


def recorded(
    number: int, *, level: str, task: str, seconds: float = 10.0, seed: int = 1, held: bool = False
) -> RecordedArm:
    """Return one log of a random hand; `held`: the motor's force stands from row to row, from some instant between."""
    draw = np.random.default_rng([seed, number])
    mass, natural, ratio = draw.uniform(0.2, 2), draw.uniform(2, 6), draw.uniform(0.2, 0.9)
    stiffness = mass * (2 * np.pi * natural) ** 2
    damping = 2 * ratio * np.sqrt(mass * stiffness)
    device = draw.uniform(0.2, 1.0), draw.uniform(0.5, 5)  # kg, N s/m
    t = np.arange(0, seconds + 0.1, FINE)
    motor = _motor(task, t, draw, stiffness)
    if held and motor.any():
        motor = _held(motor, draw)
    switches, segments, place = _target(task, seconds, draw)
    if task == "path":
        target = _reaches(t, draw)
    else:
        target = np.array(place)[np.array(segments)][np.searchsorted(switches, t, side="right")]
    x, v, a = _moved(t, motor, target, (mass, damping, stiffness), device)
    hand = -(mass * a + damping * v + stiffness * (x - target))  # on the handle
    at, keeps = _instants(level, seconds, draw)
    count = float(draw.choice([5e-6, 10e-6, 25e-6]))
    place_read = _between(t, x, v, at)
    phase = draw.uniform(0, count)
    counted = count * np.floor((place_read + phase) / count)
    drift = np.zeros(len(at))
    if level == "drift":
        walk = draw.normal(0, np.sqrt(1 / RATE), len(at)).cumsum()
        drift = draw.uniform(0.05, 0.3) * walk + draw.uniform(-0.1, 0.1) * at
    noise = draw.normal(0, draw.uniform(0.01, 0.05), len(at))
    read = np.interp(at + draw.normal(0, APART), t, hand) + drift + noise
    return RecordedArm(
        level=level,
        task=task,
        t=np.round(at, 7)[keeps],
        x=counted[keeps],
        force=read[keeps],
        count=count,
        switches=switches,
        segments=segments,
        path=np.interp(at, t, target)[keeps] if task == "path" else None,
        truth={"M0": mass, "B0": damping, "K0": stiffness},
    )


def _motor(task: str, t: Values, draw: np.random.Generator, stiffness: float) -> Values:
    """Return the motor's force towards +x [N]."""
    size = 0.015 * stiffness
    if task in ("multisine", "tapping"):
        lines = np.arange(0.3, 12, 0.4)
        phases = draw.uniform(0, 2 * np.pi, len(lines))
        wave = sum(np.sin(2 * np.pi * f * t + p) for f, p in zip(lines, phases, strict=True))
        return np.asarray(size * wave / np.sqrt(len(lines) / 2) / 2)
    if task == "sine":
        return np.asarray(size * np.sin(2 * np.pi * draw.uniform(1, 6) * t))
    return np.zeros(len(t))


def _held(motor: Values, draw: np.random.Generator) -> Values:
    """Return a motor's force that a loop at `RATE` commands, its ticks anywhere between two rows."""
    period = round(1 / (RATE * FINE))
    phase = int(draw.integers(0, period))
    last = (np.arange(len(motor)) - phase) // period * period + phase
    return np.asarray(motor[np.maximum(last, 0)])


def _target(
    task: str, seconds: float, draw: np.random.Generator
) -> tuple[tuple[float, ...], tuple[int, ...], list[float]]:
    """Return when the hand goes elsewhere [s], to which level, and the levels [m]."""
    if task in ("tapping", "alone"):
        half = np.round(0.5 / draw.uniform(1, 2.5), 3)
        at = np.arange(half, seconds - 0.1, half)
        return tuple(at.tolist()), tuple(k % 2 for k in range(len(at) + 1)), [0.0, 0.02]
    return (), (0,), [0.0]


def _reaches(t: Values, draw: np.random.Generator) -> Values:
    """Return a path of reaches, each smooth over 0.3 s [m]."""
    out = np.zeros(len(t))
    for at in np.arange(0.5, t[-1], 0.8):
        s = np.clip((t - at) / 0.3, 0, 1)
        out += draw.uniform(-0.02, 0.02) * s**3 * (10 + s * (6 * s - 15))
    return out


def _between(t: Values, x: Values, v: Values, at: Values) -> Values:
    """Return the position at other instants."""
    from scipy.interpolate import CubicHermiteSpline

    return np.asarray(CubicHermiteSpline(t, x, v)(at))


def _moved(
    t: Values,
    motor: Values,
    target: Values,
    hand: tuple[float, float, float],
    device: tuple[float, float],
) -> tuple[Values, Values, Values]:
    """Return position, velocity and acceleration: motor and target straight over a step, a jumping target held."""
    mass, damping, k = hand[0] + device[0], hand[1] + device[1], hand[2]
    from scipy.signal import cont2discrete, lfilter, ss2tf

    A = np.array([[0, 1], [-k / mass, -damping / mass]])
    B, C, D = np.array([[0], [1 / mass]]), np.eye(2), np.zeros((2, 1))
    moves = np.array([np.full(len(t), target[0]), np.zeros(len(t))])
    jumps = "zoh" if np.abs(np.diff(target)).max() > 1e-3 else "foh"
    for force, method in ((motor, "foh"), (k * (target - target[0]), jumps)):
        if force.any():
            top, bottom = ss2tf(*cont2discrete((A, B, C, D), FINE, method=method)[:4])
            moves = moves + np.array([lfilter(row, bottom, force) for row in top])
    x, v = moves
    return x, v, (motor - damping * v - k * (x - target)) / mass


def _instants(
    level: str, seconds: float, draw: np.random.Generator
) -> tuple[Values, NDArray[np.bool_]]:
    """Return when a row was read [s], and which rows the log keeps."""
    at = np.arange(0, seconds, 1 / RATE)
    keeps = np.ones(len(at), dtype=bool)
    if level != "rough":
        return at, keeps
    at = at + draw.uniform(0, 4e-5, len(at))
    keeps = draw.random(len(at)) > 0.01
    for _ in range(2):
        start = draw.uniform(0.5, seconds - 1.0)
        keeps &= ~((at > start) & (at < start + draw.uniform(0.015, 0.4)))
    return at, keeps
