"""Ceilings of wall stiffness in closed form, to print beside every result."""

from __future__ import annotations

from ebac._core import Device, Hand, Timing


def passive_ceiling(device: Device, timing: Timing, wall_damping: float = 0.0) -> float:
    """Return the largest wall stiffness that is passive without a law, K = 2 (b - |B|) / ((1 + 2 d) T) [N/m].

    Colgate and Schenkel (1994) for d = 0, where it is necessary too; with d samples of delay it is sufficient. Without
    a lag of the current loop: with one the device alone is unstable from about `delay_ceiling` on, which is less.

    Parameters
    ----------
    device : Device
        Its physical damping b [N s/m] counts, after compensation.
    timing : Timing
        Sample time T [s] and delay d [samples].
    wall_damping : float
        B of the wall on the backward difference [N s/m].
    """
    left = device.facts.damping - abs(wall_damping)
    return max(0.0, 2 * left / ((1 + 2 * timing.delay) * timing.dt))


def delay_ceiling(
    device: Device, timing: Timing, wall_damping: float = 0.0, hand: Hand | None = None
) -> float:
    """Return the largest stable wall stiffness for small wall damping, K = (b + B) / (T / 2 + t_d) [N/m].

    Gil et al. (2009). Damping outweighs what hold and delay t_d = d T + current lag take; within some per cent of the
    exact `stiffness_limit` while b + B is small against the mass over the delay, and too high beyond.

    Parameters
    ----------
    device : Device
        Its physical damping b [N s/m] and current lag [s] count.
    timing : Timing
        Sample time T [s] and delay d [samples].
    wall_damping : float
        B of the wall on the backward difference [N s/m].
    hand : Hand, optional
        Whose damping [N s/m] helps; default: nobody.
    """
    damping = device.mechanics.damping + wall_damping + (hand.damping if hand else 0.0)
    late = timing.delay * timing.dt + device.drive.current_lag
    return max(0.0, damping / (timing.dt / 2 + late))


def quantised_ceiling(device: Device, timing: Timing) -> float:
    """Return the largest passive stiffness with an encoder, K = min(2 b / T, 2 f_c / Delta) [N/m].

    Abbott and Okamura (2005): Coulomb friction f_c must pay for the energy that counts Delta create. For a wall
    without damping, without delay.

    Parameters
    ----------
    device : Device
        Its damping b [N s/m], Coulomb friction f_c [N] and count Delta [m].
    timing : Timing
        Sample time T [s].
    """
    mechanics = device.mechanics
    return min(2 * mechanics.damping / timing.dt, 2 * mechanics.coulomb / device.count)
