"""Check which parameters a log can determine: from its spectra before a fit, from the estimates after one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import named, unknown
from ebac._util.arrays import Values
from ebac._util.sequences import several
from ebac._util.wrong_calls import plain_function
from ebac.identify.guess import regression, solve
from ebac.identify.intervals import Z95
from ebac.identify.parameters import HAND, Parameters, kind
from ebac.identify.plausible import without_place
from ebac.identify.recording import Recording
from ebac.identify.recording_list import require_recordings
from ebac.identify.response import Densities, densities
from ebac.identify.target import Target, longest, require_target

ASKED = HAND
#: What to do where a log does not determine a parameter.
REMEDIES = {
    "M0": "move faster: tap, or follow a multisine that goes beyond 3 Hz",
    "B0": "move at 1 to 5 Hz: tap at a wall by a metronome",
    "K0": "let the target move, or press and hold in several places",
}
#: What to do where the log seems to hold the force of the other sign: a hand whose target moved unsaid looks alike.
FLIP = "give the target if the hand moved on its own; else --flip-force: the force acts on the hand"
#: A line is excited where the motion stands so far above what the encoder's step alone would show.
ABOVE = 10.0
#: More bands than this are represented by a few of them: a tap has a line at every harmonic.
MOST_BANDS = 6
#: Largest gap inside of a band [Hz].
GAP = 1.1


@dataclass(frozen=True, kw_only=True, eq=False)
class LogCheck:
    """Frequency bands that a log excites, and the expected standard deviation of each parameter.

    Attributes
    ----------
    name : str
        Name of the recording.
    asked : tuple of str
        Requested parameters.
    bands : tuple of (low, high)
        Bands in which the motion follows the force [Hz].
    deviation : dict
        Expected standard deviation of each parameter, relative to its value; infinite if nothing determines it.
    outside : bool
        Whether something moves hand or device from outside the loop: a target that changes, or a perturbation.
    other_sign : bool
        Whether only the force with the opposite sign can be that of a hand.
    """

    name: str
    asked: tuple[str, ...]
    bands: tuple[tuple[float, float], ...]
    deviation: dict[str, float]
    outside: bool
    other_sign: bool = False

    def determines(self, name: str) -> bool:
        """Whether the log would determine a parameter."""
        return named("parameter", name, self.deviation) * Z95 <= DETERMINED

    def bands_in_words(self) -> str:
        """Return the bands in words, such as "0.5 to 6 Hz, 9 to 10 Hz"; of many bands the first and the last."""
        words = [f"{a:.3g} to {b:.3g} Hz" for a, b in self.bands]
        if len(words) > MOST_BANDS:
            words = [*words[:3], "...", f"{words[-1]} ({len(words)} bands)"]
        return ", ".join(words) or "nothing"

    def rows(self) -> list[dict[str, Any]]:
        """Return one row for each requested parameter."""
        return [
            {
                "recording": self.name,
                "parameter": name,
                "told": self.determines(name),
                "deviation_share": self.deviation[name],
                "remedy": ""
                if self.determines(name)
                else FLIP
                if self.other_sign
                else REMEDIES[name],
            }
            for name in self.asked
        ]


@plain_function
def check_log(
    recording: Recording, target: Target | None = None, *, ask: Sequence[str] = ASKED
) -> LogCheck:
    """Check whether a log is informative enough to identify the parameters of eq. (4).

    The expected standard deviations are computed from the spectra alone: each spectral line determines
    M0 s^2 + B0 s + K0 as precisely as the force follows the motion there. This takes milliseconds and is approximate;
    the intervals of the fit are decisive.

    Parameters
    ----------
    recording : Recording
        Recording with position and force of the hand.
    target : Target, optional
        Target position of the hand; default: held in one place.
    ask : sequence of str
        Requested parameters, out of M0, B0, K0.

    Raises
    ------
    ValueError
        For an unknown name, a recording without force, or a recording that is too short.
    """
    require_recordings(recording, "check_log", rotary=True)  # shares have no unit
    ask = several("ask", ask, least=0)
    for name in ask:
        if name not in ASKED:
            raise ValueError(unknown(f"parameter {name}", name, list(ASKED)))
    target = Target.held() if target is None else target
    require_target(recording, target, "check_log")
    recording, target = longest(recording, target)
    guess, _ = solve([regression(recording, target)])
    found = densities(recording, target, guess[3:])
    hand = np.asarray(guess[:3])
    deviation = _deviations(found, hand)
    turned = (hand < 0).all() and check_log(recording.flipped(), target).determines("K0")
    return LogCheck(
        name=recording.name,
        asked=tuple(ask),
        bands=_bands(found, recording),
        deviation=dict(zip(ASKED, deviation.tolist(), strict=True)),
        outside=found.moving or bool(np.isfinite(deviation).any()),
        other_sign=bool(turned),
    )


def _coherence(found: Densities) -> Values:
    """Return how much of the force follows: of the target where it moves, of the motion otherwise."""
    d, r = found.density, found.seen_through
    share = np.abs(d[r, 2]) ** 2 / (d[r, r].real * d[2, 2].real + 1e-300)
    return np.asarray(np.clip(share, 0.0, 1 - 1e-6))


def _deviations(found: Densities, guess: Values) -> Values:
    """Return the deviations of M0, B0, K0 over their values, by the information of all lines.

    A resting hand is seen through its own motion, as long as something else moves it: then its force opposes the
    motion. Where the hand moves the device, its force shows the device, with mass and damping below zero.
    """
    if not found.moving and (guess <= 0).any():
        return np.full(3, np.inf)
    c, d, r = _coherence(found), found.density, found.seen_through
    s = 2j * np.pi * found.frequency
    columns = np.array([s**2 * d[r, 0], s * d[r, 0], d[r, 1]])
    independent = max(2.0, 0.6 * found.segments)
    variance = d[r, r].real * d[2, 2].real * (1 - c) / (2 * independent) + 1e-300
    A = np.hstack([(columns / np.sqrt(variance)).real, (columns / np.sqrt(variance)).imag])
    information = A @ A.T
    scale = np.sqrt(np.diag(information)) + 1e-300
    values, vectors = np.linalg.eigh(information / np.outer(scale, scale))
    inverse = (vectors / np.maximum(values, 1e-12)) @ vectors.T
    deviation = np.sqrt(np.diag(inverse)) / scale
    return np.where(guess > 0, deviation / np.maximum(np.abs(guess), 1e-300), np.inf)


def _bands(found: Densities, recording: Recording) -> tuple[tuple[float, float], ...]:
    """Return the bands in which the force follows and the motion stands above the encoder's step."""
    floor = ABOVE * 2 * recording.dt * recording.count**2 / 12
    significant = (_coherence(found) > 0.5) & (found.density[0, 0].real > floor)
    bands: list[tuple[float, float]] = []
    for f in found.frequency[significant].tolist():
        if bands and f - bands[-1][1] <= GAP:
            bands[-1] = (bands[-1][0], f)
        else:
            bands.append((f, f))
    return tuple(bands)


#: An estimate counts as determined when its 95 % bound is nearer than this share of it.
DETERMINED = 0.25
#: Beyond this correlation two estimates move together.
TOGETHER = 0.95
#: ... and when either is looser than this share, the log cannot separate them.
LOOSE = 0.2
#: A hand that answers within this many rows, M0/B0, depends on what a force does between rows, which is not recorded.
FASTEST = 2.0
#: ... unless its M0 and B0 are separated better than by this correlation.
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

    Where nothing separates M0, B0 and K0, all multiples of the whole device and hand fit alike, but for the least
    ones, which fit the noise between two rows of `dt` [s]: a hand that fast is not believed.
    """
    out: list[str] = []
    for i in parameters.free:
        name, value = parameters.names[i], float(values[i])
        loose = not half[i] <= DETERMINED * scale_of(name, value, span)
        if loose or _at_bound(parameters, int(i), value, float(half[i])):
            out.append(name)
    names = [parameters.names[i] for i in parameters.free]
    out += [name for name in _too_fast(parameters, values, correlation, dt) if name not in out]
    out += [name for name in _multiples(parameters, correlation) if name not in out]
    out += [name for name in without_place(parameters, values, half) if name not in out]
    lost = [names.index(name) for name in out]
    out += [
        name
        for b, name in enumerate(names)
        if b not in lost and any(abs(correlation[a, b]) > TOGETHER for a in lost)
    ]
    return tuple(out)


def _at_bound(parameters: Parameters, index: int, value: float, half: float = 0.0) -> bool:
    """Return whether a search ended at a bound, or its interval reaches one: beyond lies what was not tried."""
    low, high = float(parameters.low[index]), float(parameters.high[index])
    near = max(half, 1e-9 * (high - low))
    return value <= low + near or value >= high - near


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


def _multiples(parameters: Parameters, correlation: NDArray[np.float64]) -> list[str]:
    """Return M0, B0, K0 of each hand of which only multiples differ: all three move together.

    That is a hand that moves the device on its own: what then seems to separate the multiples is an error of the
    readings, such as jitter. On a hand that something else moves the three differ: 0.4 is much.
    """
    names, free, out = parameters.names, parameters.free.tolist(), list[str]()
    for place in parameters.places:
        hand = [free.index(i) for i in place[:3].tolist() if i in free]
        if len(hand) == 3 and correlation[np.ix_(hand, hand)].min() > TOGETHER:
            out += [names[free[i]] for i in hand if names[free[i]] not in out]
    return out


def inseparable(
    parameters: Parameters,
    values: NDArray[np.float64],
    half: NDArray[np.float64],
    correlation: NDArray[np.float64],
    span: float,
) -> tuple[tuple[str, str, float], ...]:
    """Return pairs that this log cannot separate, with their correlation."""
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
