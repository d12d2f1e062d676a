"""What a log can tell, and what it cannot."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac.identify.parameters import Parameters, kind

#: An estimate counts as determined when its 95 % bound is nearer than this share of it.
DETERMINED = 0.25
#: Beyond this correlation two estimates move together.
TOGETHER = 0.95
#: ... and when either is looser than this share, the log cannot tell them apart.
LOOSE = 0.2
#: A hand that answers within so many rows, M0/B0, is told by what a force does between rows: by nothing recorded.
FASTEST = 2.0
#: ... unless its M0 and B0 are told apart better than by this correlation.
FAST_TOGETHER = 0.85


def scale_of(name: str, value: float, span: float) -> float:
    """Return what an error is compared with: the value; for a place the motion [m]; for a time 10 ms."""
    what = kind(name)
    if what == "X0":
        return max(abs(value), span)
    if what in ("delay", "onset"):
        return max(abs(value), 0.01)
    return abs(value)


def undetermined(
    parameters: Parameters,
    values: NDArray[np.float64],
    half: NDArray[np.float64],
    correlation: NDArray[np.float64],
    span: float,
    dt: float,
) -> tuple[str, ...]:
    """Return the free parameters the log does not determine: too loose, at a bound, or moving with one that is.

    Where nothing tells M0, B0 and K0 apart, all multiples of the whole device and hand fit alike, but for the least
    ones, which fit the noise between two rows of `dt` [s]: a hand that fast is not believed.
    """
    out: list[str] = []
    for i in parameters.free:
        name, value = parameters.names[i], float(values[i])
        if _at_bound(parameters, int(i), value) or not half[i] <= DETERMINED * scale_of(
            name, value, span
        ):
            out.append(name)
    names = [parameters.names[i] for i in parameters.free]
    out += [name for name in _too_fast(parameters, values, correlation, dt) if name not in out]
    lost = [names.index(name) for name in out]
    out += [
        name
        for b, name in enumerate(names)
        if b not in lost and any(abs(correlation[a, b]) > TOGETHER for a in lost)
    ]
    return tuple(out)


def _at_bound(parameters: Parameters, index: int, value: float) -> bool:
    low, high = float(parameters.low[index]), float(parameters.high[index])
    return value <= low + 1e-9 * (high - low) or value >= high - 1e-9 * (high - low)


def _too_fast(
    parameters: Parameters,
    values: NDArray[np.float64],
    correlation: NDArray[np.float64],
    dt: float,
) -> list[str]:
    """Return M0, B0, K0 of each hand faster than `FASTEST` rows whose M0 moves with its B0 or lies at a bound."""
    free = parameters.free.tolist()
    out: list[str] = []
    for place in parameters.places:
        m, b = int(place[0]), int(place[1])
        if not (m in free and b in free and values[m] < FASTEST * dt * values[b]):
            continue
        together = abs(correlation[free.index(m), free.index(b)]) > FAST_TOGETHER
        if together or _at_bound(parameters, m, float(values[m])):
            names = [parameters.names[i] for i in place[:3] if i in free]
            out += [name for name in names if name not in out]
    return out


def inseparable(
    parameters: Parameters,
    values: NDArray[np.float64],
    half: NDArray[np.float64],
    correlation: NDArray[np.float64],
    span: float,
) -> tuple[tuple[str, str, float], ...]:
    """Return pairs that this log cannot tell apart, with their correlation."""
    out = []
    free = parameters.free
    loose = [
        not half[i] <= LOOSE * scale_of(parameters.names[i], float(values[i]), span) for i in free
    ]
    for a in range(len(free)):
        for b in range(a + 1, len(free)):
            r = float(correlation[a, b])
            if abs(r) > TOGETHER and (loose[a] or loose[b]):
                out.append((parameters.names[free[a]], parameters.names[free[b]], r))
    return tuple(sorted(out, key=lambda pair: -abs(pair[2])))
