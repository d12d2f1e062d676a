"""Synthetic twins of the recordings in `public_recordings`: same variables, rate, excitation; no line of the product.

The axis has the parameters that were published for it, and the controller, the trapezoids and the encoder of its
recordings. The arm leads a robot that renders a mass and a damper, and the six trials are in a struct array.
"""

from __future__ import annotations

from math import copysign, pi, sin

import numpy as np
from numpy.typing import NDArray
from recorded_arm import FINE, _motor, _moved, _reaches

Values = NDArray[np.float64]

#: gtau vir = M a + Fv v + Fc sign(v) + offset: A. Janot, M. Gautier, M. Brunot, Data Set and Reference Models of
#: EMPS, 2019 Workshop on Nonlinear System Identification Benchmarks (hal-02178709), table of IDIM-LS.
PUBLISHED = {"M": 95.1089, "Fv": 203.5034, "Fc": 20.3935, "offset": -3.1648}  # kg, N s/m, N, N
#: Drive [N/V], position loop [1/s], velocity loop [V s/m], drive's limit [V], step of the encoder [m].
GTAU, KP, KV, LIMIT, STEP = 35.15065188248547, 160.18, 243.45, 10.0, 5e-8
#: Time to a speed and time at it [s], three trapezoids there and three back; acceleration [m/s^2].
MOVES, ACCELERATION = ((0.05, 0.351), (0.098, 0.687), (0.148, 1.035)), 0.83
#: What no model of the axis has, about as large as in the recording: a force that the ball screw has every 2.5 mm,
#: its amplitude [N], and one that changes within 5 ms [N]. A wave along the way would have this length [m].
SCREW, TURN, SHAKES, WITHIN, WAVE = 1.3, 2.5e-3, 1.2, 5e-3, 0.17
#: What the robot renders [kg, N s/m], and the hand that leads it [kg, N s/m, N/m].
ROBOT, HAND = (4.0, 25.0), {"M0": 0.8, "B0": 12.0, "K0": 350.0}


def reference(seconds: float) -> Values:
    """Return the reference of the position [m], one value a millisecond."""
    lap = []
    for way in (1, -1):
        for rise, cruise in MOVES:
            n, m = round(1e3 * rise), round(1e3 * cruise)
            lap += [way * ACCELERATION] * n + [0.0] * m + [-way * ACCELERATION] * n
    rows = round(1e3 * seconds) + 1
    acceleration = np.resize(lap, rows)
    velocity = 1e-3 * np.concatenate([[0.0], np.cumsum(acceleration)])[:-1]
    return np.asarray(1e-3 * np.cumsum(velocity) + 2.5e-4)


def axis(
    seconds: float = 24.84,
    screw: float = SCREW,
    shakes: float = SHAKES,
    along: float = 0.0,
    seed: int = 1,
) -> dict[str, Values]:
    """Return the variables of DATA_EMPS.mat, of a simulated axis and three forces its model does not have [N]."""
    from scipy.signal import lfilter

    draw = np.random.default_rng(seed)
    mass, viscous, coulomb, offset = PUBLISHED.values()
    wanted = reference(seconds)
    rows, inner = len(wanted), 10
    h = 1e-3 / inner
    phase, other = draw.uniform(0, 2 * pi, 2)
    kept = np.exp(-1e-3 / WITHIN)
    shaking = lfilter([shakes * np.sqrt(1 - kept**2)], [1, -kept], draw.normal(0, 1, rows))
    decay = np.exp(-h * viscous / mass)
    push = (1 - decay) / viscous  # m/s for one N over a step
    q, v, before = 0.0, 0.0, 0.0
    qm, vir = np.zeros(rows), np.zeros(rows)
    for k in range(rows):
        read = STEP * round(q / STEP)
        volts = KV * (KP * (wanted[k] - read) - 1e3 * (read - before))
        before, vir[k] = read, min(max(volts, -LIMIT), LIMIT)
        for _ in range(inner):
            left = shaking[k] + screw * sin(2 * pi * q / TURN + phase)
            left += along * sin(2 * pi * q / WAVE + other)
            free = decay * v + push * (GTAU * vir[k] - offset - left)
            slid = max(abs(free) - push * coulomb, 0.0)  # friction stops it, and holds it
            q += 0.5 * h * v
            v = copysign(slid, free)
            q += 0.5 * h * v
        qm[k] = STEP * round(q / STEP)  # at the end of the tick in which the drive gave vir
    column = {"qg": wanted, "qm": qm, "t": 1e-3 * np.arange(rows), "vir": vir}
    scalar = {"gtau": GTAU, "kp": KP, "kv": KV}
    return {name: np.reshape(values, (-1, 1)) for name, values in (column | scalar).items()}


def trials(
    seconds: float = 6.0, pushed: bool = False, seed: int = 1
) -> dict[str, NDArray[np.void]]:
    """Return the variable of symbol_data.mat: six trials of `pos`, `vel`, `F`, each 3 x rows, and the `path` led along.

    `F` is the force of the hand on the robot; `path`, which the recordings do not have, is what the hand had in mind.
    A robot that is `pushed` by its motors does more than follow.
    """
    draw = np.random.default_rng(seed)
    names = ("pos", "vel", "F", "path")
    out = np.zeros((1, 6), dtype=[(name, object) for name in names])
    for i in range(6):
        t = np.arange(0, seconds + draw.uniform(0, 2), FINE)
        rows = slice(None, None, round(1e-3 / FINE))
        found = []
        for _ in range(3):
            path = 3 * _reaches(t, draw)
            hand = tuple(HAND.values())
            push = _motor("multisine" if pushed else "path", t, draw, HAND["K0"])
            x, v, a = _moved(t, push, path, hand, ROBOT)
            force = ROBOT[0] * a + ROBOT[1] * v - push
            noise = draw.normal(0, 0.02, len(t[rows]))
            found.append((x[rows] - 0.4, v[rows], force[rows] + noise, path[rows] - 0.4))
        for name, values in zip(names, zip(*found, strict=True), strict=True):
            out[0, i][name] = np.array(values)
    return {"symbol_data": out}
