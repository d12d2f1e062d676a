"""Does a log excite what is asked of it? Told from its spectra, before anything is fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.document import unknown
from ebac.identify.guess import regression, solve
from ebac.identify.recording import Recording
from ebac.identify.response import Densities, densities
from ebac.identify.target import Target
from ebac.identify.verdict import DETERMINED

Values = NDArray[np.float64]

ASKED = ("M0", "B0", "K0")
#: What to do where a log does not tell a parameter.
REMEDIES = {
    "M0": "move faster: tap, or follow a multisine that goes beyond 3 Hz",
    "B0": "move at 1 to 5 Hz: tap at a wall by a metronome",
    "K0": "let the target move, or press and hold in several places",
}
#: A line is excited where the motion stands so far above what the encoder's step alone would show.
ABOVE = 10.0
#: More bands than this are told by a few of them: a tap has a line at every harmonic.
MOST_BANDS = 6
#: Largest gap inside of a band [Hz].
GAP = 1.1


@dataclass(frozen=True, kw_only=True, eq=False)
class LogCheck:
    """What a log excites, and with what deviation it would tell each parameter.

    Attributes
    ----------
    name : str
        Of the recording.
    asked : tuple of str
        Parameters that were asked for.
    bands : tuple of (low, high)
        Where the motion follows the force, in Hz.
    deviation : dict
        Expected standard deviation of each parameter as a share of it; infinite where nothing tells.
    outside : bool
        Whether something moves the hand from outside the loop: a target that changes.
    """

    name: str
    asked: tuple[str, ...]
    bands: tuple[tuple[float, float], ...]
    deviation: dict[str, float]
    outside: bool

    def told(self, name: str) -> bool:
        """Whether the log would determine a parameter."""
        return self.deviation[name] * 1.96 <= DETERMINED

    def bands_in_words(self) -> str:
        """Return "0.5 to 6 Hz, 9 to 10 Hz", or that there is nothing; of many bands the first and the last."""
        words = [f"{a:.3g} to {b:.3g} Hz" for a, b in self.bands]
        if len(words) > MOST_BANDS:
            words = [*words[:3], "...", f"{words[-1]} ({len(words)} bands)"]
        return ", ".join(words) or "nothing"

    def rows(self) -> list[dict[str, Any]]:
        """Return one row for each parameter that was asked for."""
        return [
            {
                "recording": self.name,
                "parameter": name,
                "told": self.told(name),
                "deviation_share": self.deviation[name],
                "remedy": "" if self.told(name) else REMEDIES[name],
            }
            for name in self.asked
        ]


def check_log(
    recording: Recording, target: Target | None = None, *, ask: Sequence[str] = ASKED
) -> LogCheck:
    """Say which bands a log excites, and whether it can tell the parameters of eq. (4).

    The expected deviations come from the spectra alone: each line tells of M0 s^2 + B0 s + K0 as much as the force
    follows the motion there. A rough answer in milliseconds; the fit has the last word.

    Parameters
    ----------
    recording : Recording
        With position and force of the hand.
    target : Target, optional
        Where the hand wanted to be; default: held in one place.
    ask : sequence of str
        Of M0, B0, K0.

    Raises
    ------
    ValueError
        For a name that is none of these, without force, or when the recording is too short.
    """
    for name in ask:
        if name not in ASKED:
            raise ValueError(unknown(f"parameter {name}", name, list(ASKED)))
    target = target or Target.held()
    guess, _ = solve([regression(recording, target)])
    found = densities(recording, target, guess[3:])
    deviation = _deviations(found, np.asarray(guess[:3]))
    return LogCheck(
        name=recording.name,
        asked=tuple(ask),
        bands=_bands(found, recording),
        deviation=dict(zip(ASKED, deviation.tolist(), strict=True)),
        outside=found.moving,
    )


def _coherence(found: Densities) -> Values:
    """Return how much of the force follows: of the target where it moves, of the motion otherwise."""
    d, r = found.density, 3 if found.moving else 0
    share = np.abs(d[r, 2]) ** 2 / (d[r, r].real * d[2, 2].real + 1e-300)
    return np.asarray(np.clip(share, 0.0, 1 - 1e-6))


def _deviations(found: Densities, guess: Values) -> Values:
    """Return the deviations of M0, B0, K0 over their values, by the information of all lines.

    A hand whose target rests and that meets nothing shows the device and not itself: nothing is known from outside.
    """
    if not found.moving:
        return np.full(3, np.inf)
    c, d = _coherence(found), found.density
    s = 2j * np.pi * found.frequency
    columns = np.array([s**2 * d[3, 0], s * d[3, 0], d[3, 1]])
    independent = max(2.0, 0.6 * found.segments)
    variance = d[3, 3].real * d[2, 2].real * (1 - c) / (2 * independent) + 1e-300
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
    told = (_coherence(found) > 0.5) & (found.density[0, 0].real > floor)
    bands: list[tuple[float, float]] = []
    for f in found.frequency[told].tolist():
        if bands and f - bands[-1][1] <= GAP:
            bands[-1] = (bands[-1][0], f)
        else:
            bands.append((f, f))
    return tuple(bands)
