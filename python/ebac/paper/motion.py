"""Eq. (4) to (7): hand and device, checked against the closed form of their free motion."""

from __future__ import annotations

from functools import cache

import numpy as np

from ebac._core import Free, Step
from ebac._util import formatting
from ebac.paper.finding import Claim, Finding, judge, row
from ebac.scenario import Scenario
from ebac.simulation import simulate
from ebac.trace import Trace

#: Simulation and closed form agree to this share of the target.
AGREES = 1e-9
TARGET = 0.04  # m, as in Fig. 5


@cache
def _free() -> tuple[Trace, float, float]:
    """Return a free motion with its largest error in position [m] and velocity [m/s] from the closed form."""
    scenario = Scenario(environment=Free(), seconds=1.0)
    scenario = scenario.replace(hand=scenario.hand.replace(path=Step(target=TARGET)))
    trace = simulate(scenario, "direct")
    hand, device = scenario.hand, scenario.device
    roots = np.roots(
        [hand.mass + device.mass, hand.damping + device.mechanics.damping, hand.stiffness]
    )
    weights = np.linalg.solve(np.array([[1, 1], roots]), np.array([-TARGET, 0.0]))
    modes = np.exp(np.outer(roots, trace["t"]))
    x = TARGET + (weights @ modes).real
    v = ((weights * roots) @ modes).real
    return (
        trace,
        float(np.abs(trace["true.x"] - x).max()),
        float(np.abs(trace["true.v"] - v).max()),
    )


def _agrees() -> Claim:
    _, error, _ = _free()
    return Claim(
        text="hand and device together move as mass, damper and spring, with F_h acting on the device",
        holds=error < AGREES * TARGET,
        evidence=f"simulation and closed form differ by at most {1e9 * error:.2g} nm",
    )


def eq4() -> Finding:
    """Check the hand's model, and the signs of eq. (4) and (6) taken together."""
    scenario = Scenario()
    hand, device = scenario.hand, scenario.device
    printed = np.roots(
        [hand.mass - device.mass, hand.damping - device.mechanics.damping, hand.stiffness]
    )
    fastest = float(printed.real.max())
    agrees = _agrees()
    signs = Claim(
        text="eq. (4) and (6) as printed, both with F_h of one sign, describe a handle that rests at X_0",
        holds=fastest < 0,
        evidence=f"the free handle runs away with exp({fastest:.3g} t), t in s",
    )
    return Finding(
        name="eq4",
        title="Eq. (4): the human hand",
        claim="M_0 dV_h/dt + B_0 V_h + K_0 (X_h - X_0) = F_h.",
        rows=[
            row("free motion, largest difference to the closed form", _free()[1], "m"),
            row("fastest root of eq. (4) and (6) as printed", fastest, "1/s"),
        ],
        verdict=judge(agrees, signs),
        why="The model holds when F_h of eq. (4) is the force on the hand, of eq. (6) the force on "
        "the device: opposite signs. With one sign for both, the masses subtract and the free "
        "handle runs away.",
        claims=(agrees, signs),
    )


def eq5() -> Finding:
    """Check that the hand's velocity is the derivative of its position."""
    trace, _, error = _free()
    fastest = float(np.abs(trace["true.v"]).max())
    return Finding(
        name="eq5",
        title="Eq. (5): velocity of the hand",
        claim="V_h = dX_h/dt.",
        rows=[
            row("largest velocity", fastest, "m/s"),
            row("largest difference to the derivative of the closed form", error, "m/s"),
        ],
        verdict=judge(error < AGREES * fastest),
        why="A definition; the simulated velocity is the derivative of the position.",
    )


def eq6() -> Finding:
    """Check the device's dynamics."""
    agrees = _agrees()
    return Finding(
        name="eq6",
        title="Eq. (6): dynamics of the device",
        claim="F_h = M_h dV_h/dt + B_h V_h + F_d.",
        rows=[row("free motion, largest difference to the closed form", _free()[1], "m")],
        verdict=judge(agrees),
        why="Holds with F_h acting on the device; see eq4 for the sign of F_h there.",
        claims=(agrees,),
    )


def eq7() -> Finding:
    """Check that hand and device share one velocity, and how well the law sees it."""
    trace, _, _ = _free()
    seen = float(np.abs(trace["v"] - trace["true.v"]).max())
    count = trace.scenario.device.count if trace.scenario else 0.0
    return Finding(
        name="eq7",
        title="Eq. (7): hand and handle move together",
        claim="V_h = V_d.",
        rows=[
            row("free motion of both as one body, difference to the closed form", _free()[1], "m"),
            row("largest error of the velocity that a law sees", seen, "m/s"),
            row("one encoder count per tick", count / 1e-3, "m/s"),
        ],
        verdict=judge(_agrees()),
        why="A rigid grip, which the simulation assumes as well. A law sees the velocity through the "
        f"encoder, with errors of up to {formatting.quantity(seen, 'm/s')}.",
    )
