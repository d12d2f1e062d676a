"""Whether the numbers of a log are those of a hand, or in a wrong unit."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

import numpy as np

from ebac.identify.parameters import kind
from ebac.identify.recording import LEAST_ROWS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ebac.identify.files import Columns
    from ebac.identify.parameters import Parameters

#: What no hand does, by signal: more than this is a wrong unit [m, N], and so is less [m].
FARTHEST = {"x": 2.5, "target": 2.5, "force": 5e3, "motor": 5e3, "desired": 5e3}
NEAREST = 1e-5
#: An angle without unit that spans more is one in degrees [rad].
WIDEST = 4 * pi
#: Rows farther apart contain nothing about a hand [s].
SLOWEST = 0.1

#: A hand goes back to its place within so long, B0/K0 [s].
RETURNS = 3.0


#: What human arms, hands and fingers have, by far: M0 [kg], B0 [N s/m], K0 [N/m].
HUMAN = {"M0": (0.01, 10.0), "B0": (0.2, 300.0), "K0": (10.0, 2e4)}


def is_hand(parameters: Parameters, values: NDArray[np.float64]) -> bool:
    """Return whether all values of each hand are within what humans have; those that are given are not asked."""
    free = parameters.free.tolist()
    return all(
        low <= values[i] <= high
        for place in parameters.places
        for i in place[:3].tolist()
        for low, high in (HUMAN[kind(parameters.names[i])],)
        if i in free
    )


def without_place(
    parameters: Parameters, values: NDArray[np.float64], half: NDArray[np.float64]
) -> list[str]:
    """Return M0 and B0 of each hand that surely has next to no stiffness: it is the device, seen by the other sign.

    `half` is half of each parameter's interval.
    """
    free, out = parameters.free.tolist(), list[str]()
    for place in parameters.places:
        m, b, k = place[:3].tolist()
        if k in free and values[k] + half[k] < values[b] / RETURNS:
            names = [parameters.names[i] for i in (m, b) if i in free]
            out += [name for name in names if name not in out]
    return out


def plausible(
    name: str, signals: Columns, *, rotary: bool, guessed: bool, rate: float | None = None
) -> None:
    """Refuse numbers in a wrong unit, as far as that shows, and a force that never changes.

    Parameters
    ----------
    name : str
        Of the file.
    signals : dict of arrays, shape (rows,)
        In SI units.
    rotary : bool
        Whether they are in rad and N m.
    guessed : bool
        Whether the unit of x was not given.
    rate : float, optional
        Rows per second [Hz], where the times were made of them.
    """
    long, strong = ("rad", "N m") if rotary else ("m", "N")
    dt, reach = float(np.median(np.diff(signals["t"]))), float(np.ptp(signals["x"]))
    if len(signals["t"]) >= LEAST_ROWS and reach > 0 and dt > SLOWEST:
        if rate is not None:
            raise ValueError(
                f"{name}: rate = {rate:g} Hz: rows are then {dt:.4g} s apart, {SLOWEST:g} s at most resolve a hand; "
                "give the rows per second of the log, or leave it out where the log has times"
            )
        raise ValueError(
            f"{name}: rows are {dt:.4g} s apart, {SLOWEST:g} s at most resolve a hand: is the unit of t right? "
            "Give the unit: units={'t': 'ms'} or --unit t=ms"
        )
    if 0 < reach < NEAREST:
        raise ValueError(
            f"{name}: x spans {1e6 * reach:.4g} u{long}, less than a hand that holds still: is its unit right? "
            f"Give the unit: units={{'x': '{long}'}} or --unit x={long}"
        )
    if "force" in signals and np.ptp(signals["force"]) == 0:
        raise ValueError(
            f"{name}: force is constant at {signals['force'][0]:g} {strong}: "
            "the sensor was off, or it is the wrong column"
        )
    if rotary:
        if guessed and reach > WIDEST:
            raise ValueError(
                f"{name}: x spans {reach:.4g} rad, two turns are {WIDEST:.4g}: is its unit right? "
                "Give the unit: units={'x': 'deg'} or --unit x=deg"
            )
        return
    for key, most in FARTHEST.items():
        if key not in signals:
            continue
        span = float(np.ptp(signals[key]))
        if span > most:
            unit = "m" if key in ("x", "target") else "N"
            raise ValueError(
                f"{name}: {key} spans {span:.4g} {unit}, a hand {most:g} {unit} at most: is its unit right? "
                f"Give the unit: units={{'{key}': 'm{unit}'}} or --unit {key}=m{unit}"
            )
