"""A second plant for hands with a model: one straight axis by the implicit midpoint rule, from the equations.

It shares nothing with the core but the numbers of device and hand: it is driven by the currents of a recorded run.
"""

from __future__ import annotations

from collections.abc import Callable
from math import copysign, exp, log, pi, sqrt

import ebac

#: Parts of a tick.
PARTS = 16

State = list[float]
#: (t, x, v, target, own states, past) to (force on the handle, rates of the own states).
Law = Callable[[float, float, float, float, State, list[tuple[float, float]]], tuple[float, State]]


def minimum_jerk(s: float) -> float:
    s = min(max(s, 0.0), 1.0)
    return s**3 * (10 - 15 * s + 6 * s * s)


def reflex(hand: ebac.Hand, step: float) -> tuple[Law, int, float]:
    p = hand.model
    back = round(p.delay / step)
    w = 2 * pi * p.activation

    def law(t, x, v, target, z, past):  # type: ignore[no-untyped-def]
        # the middle of the step that lies `back` steps before this one
        felt = [(0.0, 0.0), (0.0, 0.0)] if len(past) <= back else past[-back - 1 :][:2]
        before, after = felt
        x_d, v_d = (before[0] + after[0]) / 2, (before[1] + after[1]) / 2
        u = p.stretch_gain * hand.stiffness * (target - x_d) - p.velocity_gain * hand.damping * v_d
        force = hand.stiffness * (target - x) - hand.damping * v + z[0]
        return force, [z[1], w * w * (u - z[0]) - 2 * p.activation_damping * w * z[1]]

    return law, 2, hand.mass


def finger_pad(hand: ebac.Hand, step: float) -> tuple[Law, int, float]:
    p = hand.model
    bend = log(p.stiffest / p.stiffness) / p.rise
    at_bend = (p.stiffest - p.stiffness) / p.rise

    def law(t, x, v, target, z, past):  # type: ignore[no-untyped-def]
        d = abs(z[0] - x)
        f = (
            p.stiffness / p.rise * (exp(p.rise * d) - 1)
            if d < bend
            else at_bend + p.stiffest * (d - bend)
        )
        f = copysign(f, z[0] - x)
        force = f - p.fast * z[2] - p.medium * z[3] - p.slow * z[4]
        a = (hand.stiffness * (target - z[0]) - hand.damping * z[1] - force) / hand.mass
        return force, [z[1], a, (f - z[2]) / 4e-3, (f - z[3]) / 70e-3, (f - z[4]) / 1.4]

    return law, 5, 0.0


def nonlinear_grip(hand: ebac.Hand, step: float) -> tuple[Law, int, float]:
    p = hand.model

    def law(t, x, v, target, z, past):  # type: ignore[no-untyped-def]
        e = abs(target - x)
        soft = p.force * (exp(min(hand.stiffness * e / p.force, log(p.stiffest))) - 1)
        rest = e - p.force / hand.stiffness * log(p.stiffest)
        f = soft + max(rest, 0.0) * p.stiffest * hand.stiffness
        k = min(1 + f / p.force, p.stiffest)
        return copysign(f, target - x) - hand.damping * sqrt(k) * v, []

    return law, 0, hand.mass


def let_go(hand: ebac.Hand, step: float) -> tuple[Law, int, float]:
    p = hand.model

    def law(t, x, v, target, z, past):  # type: ignore[no-untyped-def]
        s = 1 - minimum_jerk((t - p.open_at) / p.ramp) + minimum_jerk((t - p.closed_at) / p.ramp)
        force = s * (p.stiffness * (z[0] - x) + p.damping * (z[1] - v))
        spring = hand.stiffness * (s * (target - z[0]) + (1 - s) * (x - z[0]))
        return force, [z[1], (spring - hand.damping * z[1] - force) / hand.mass]

    return law, 2, 0.0


LAWS = {
    ebac.hands.Reflex: reflex,
    ebac.hands.FingerPad: finger_pad,
    ebac.hands.NonlinearGrip: nonlinear_grip,
    ebac.hands.LetGo: let_go,
}


def follow(trace: ebac.Trace) -> tuple[list[float], list[float]]:
    """Return position [m] and force of the hand [N] at every row, under the currents that acted in a run."""
    scenario = trace.scenario
    assert scenario is not None
    device, hand, dt = scenario.device, scenario.hand, scenario.timing.dt
    h = dt / PARTS
    law, own, moving = LAWS[type(hand.model)](hand, h)
    mass = device.mass + moving
    damping, lag = device.mechanics.damping, device.drive.current_lag
    target = hand.path[0].target
    y = [0.0] * (3 + own)  # x, v, motor force, states of the hand
    past: list[tuple[float, float]] = [(0.0, 0.0)]
    xs, forces = [0.0], [0.0]

    def slope(t: float, y: State, u: float) -> State:
        force, rates = law(t, y[0], y[1], target, y[3:], past)
        return [y[1], (force - damping * y[1] - y[2]) / mass, (u - y[2]) / lag, *rates]

    for row, ampere in enumerate(trace["current_applied"][1:].tolist()):
        u = device.force(ampere)
        for part in range(PARTS):
            t = row * dt + part * h
            end = y
            for _ in range(50):
                middle = [(a + b) / 2 for a, b in zip(y, end, strict=True)]
                new = [a + h * b for a, b in zip(y, slope(t + h / 2, middle, u), strict=True)]
                done = max(abs(a - b) for a, b in zip(new, end, strict=True)) < 1e-12
                end = new
                if done:
                    break
            y = end
            past.append((y[0], y[1]))
        xs.append(y[0])
        now = law((row + 1) * dt, y[0], y[1], target, y[3:], past)[0]
        forces.append(now - moving * slope((row + 1) * dt, y, u)[1])
    return xs, forces
