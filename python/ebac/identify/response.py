"""Frequency response of the hand, for figures, for a first guess, and to check what a log excites."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number
from ebac._util.arrays import Values
from ebac._util.sequences import several_numbers
from ebac._util.wrong_calls import plain_function
from ebac.identify.missing import force_of_hand
from ebac.identify.recording import Recording
from ebac.identify.recording_list import require_recordings
from ebac.identify.target import Target, indicators, lagged, require_target

Lines = NDArray[np.complex128]

#: Longest segment [s]: lines every 0.5 Hz.
SEGMENT = 2.0
#: A hand does nothing of its own beyond this [Hz].
HIGHEST = 60.0
#: A target that moves by less than this share of the motion rests: what it shows is its rounding.
RESTS = 1e-3
#: Fewest segments: with fewer the coherence means nothing, with one it is always 1.
FEWEST = 4
#: Share of the segments that counts as independent: half overlapping, Hann's window (Welch 1967).
INDEPENDENT = 0.6


@dataclass(frozen=True, kw_only=True, eq=False)
class Response:
    """Frequency response of the hand, force over motion: Z(f) = K0 + B0 s + M0 s^2 at s = 2 pi f i.

    Attributes
    ----------
    frequency : array, shape (lines,)
        Frequency of each spectral line [Hz].
    stiffness : array of complex, shape (lines,)
        H1: cross spectrum of motion and force over the spectrum of the motion [N/m].
    by_target : array of complex or None
        The same with the target as instrument, so that noise fed back by a law drops out. None if it never moves.
    coherence : array, shape (lines,)
        Share of the force that follows the motion, 0 to 1.
    motion : array, shape (lines,)
        Spectral density of the position [m^2/Hz].
    segments : int
        Number of averaged segments, which overlap by half.
    """

    frequency: Values
    stiffness: Lines
    by_target: Lines | None
    coherence: Values
    motion: Values
    segments: int

    @property
    def independent(self) -> float:
        """Equivalent number of independent segments in the averages."""
        return max(2.0, INDEPENDENT * self.segments)

    @property
    def significant(self) -> float:
        """Coherence that unrelated signals exceed in one of twenty spectral lines."""
        return float(1 - 0.05 ** (1 / (self.independent - 1)))

    def model(self, mass: float, damping: float, stiffness: float) -> Lines:
        """Return Z of eq. (4) at the same spectral lines [N/m], from kg, N s/m, N/m."""
        s = 2j * np.pi * self.frequency
        return np.asarray(stiffness + damping * s + mass * s**2)

    def deviation(self) -> Values:
        """Return the standard deviation of Z at each line [N/m], from the coherence (Bendat and Piersol)."""
        c = np.clip(self.coherence, 1e-6, 1 - 1e-9)
        return np.asarray(np.abs(self.stiffness) * np.sqrt((1 - c) / c / (2 * self.independent)))

    def __repr__(self) -> str:
        """Return one line: lines, band, coherence."""
        f, share = self.frequency, float((self.coherence > self.significant).mean())
        return (
            f"<Response: {len(f)} lines, {f[0]:.3g} to {f[-1]:.3g} Hz, {self.segments} segments; "
            f"{100 * share:.0f} % of the lines coherent; Z in .stiffness>"
        )


def spectra(signals: Values, dt: float, segment: int) -> tuple[Values, NDArray[np.complex128], int]:
    """Return lines [Hz] and cross spectral densities, shape (signals, signals, lines), by Welch's method.

    Hann's window, half overlapping, the mean of each segment taken off; one-sided, as `scipy.signal.csd`.
    """
    rows = signals.shape[1]
    starts = np.arange(0, rows - segment + 1, segment // 2)
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(segment) / segment)
    parts = np.array([signals[:, s : s + segment] for s in starts])
    parts = (parts - parts.mean(axis=2, keepdims=True)) * window
    lines = np.fft.rfft(parts, axis=2)
    density = np.einsum("nif,njf->ijf", lines.conj(), lines) / len(starts)
    density *= 2 * dt / float(window @ window)
    density[..., 0] /= 2
    if segment % 2 == 0:
        density[..., -1] /= 2
    return np.asarray(np.fft.rfftfreq(segment, dt), dtype=float), density, len(starts)


@dataclass(frozen=True, kw_only=True, eq=False)
class Densities:
    """Cross spectra of x, x - X0, -F and X0 of one recording, at the lines of a hand."""

    frequency: Values
    density: Lines  # (4, 4, lines), conj(first) second
    segments: int
    moving: bool

    @property
    def seen_through(self) -> int:
        """The signal through which the hand is seen: the target where it moves, the motion otherwise."""
        return 3 if self.moving else 0


def densities(recording: Recording, target: Target, levels: Values) -> Densities:
    """Return the spectra that eq. (4) relates.

    Raises
    ------
    ValueError
        Without force, or when the recording is too short for four segments.
    """
    force = force_of_hand(recording)
    rows, dt = len(recording.t), recording.dt
    segment = min(round(SEGMENT / dt), 2 * rows // (FEWEST + 1)) // 2 * 2
    if segment < 16:
        raise ValueError(
            f"{recording.name}: {rows} rows are too few for a frequency response: needs at least 40"
        )
    wanted = levels @ indicators(recording, target)
    if target.path is not None:
        wanted = wanted + lagged(target.path, dt, recording.lag)
    x = lagged(recording.x, dt, recording.lag)
    signals = np.array([x, x - wanted, -force, wanted])
    frequency, density, count = spectra(signals, dt, segment)
    use = (frequency > 0) & (frequency <= min(HIGHEST, 0.4 / dt))
    return Densities(
        frequency=frequency[use],
        density=density[..., use],
        segments=count,
        moving=float(np.ptp(wanted)) > RESTS * float(np.ptp(x)),
    )


@plain_function
def frequency_response(
    recording: Recording,
    target: Target | None = None,
    levels: Values | None = None,
    stiffness: float = 0.0,
) -> Response:
    """Estimate Z(f) of the hand from one recording, by Welch's method.

    Parameters
    ----------
    recording : Recording
        Recording with position and force of the hand; if it has pauses, its longest stretch is used.
    target : Target, optional
        Target position of the hand; default: held in one place.
    levels : array, optional
        The levels of the target [m], shape (levels,); default: 0.
    stiffness : float
        K0 [N/m], with which a moving target pulls; this part is subtracted from the force. It has no effect while the
        target rests.

    Raises
    ------
    ValueError
        Without force, when the recording is too short for four segments, for another number of levels than the
        target has, or for a number that is not finite.
    """
    require_recordings(recording, "frequency_response")
    target = Target.held() if target is None else target
    require_target(recording, target, "frequency_response")
    given = [0.0] * target.levels if levels is None else several_numbers("levels", levels)
    levels = np.array(given)
    if levels.shape != (target.levels,):
        raise ValueError(
            f"levels has the shape {levels.shape}: must be ({target.levels},), a place [m] for each level of the target"
        )
    if not np.isfinite(levels).all():
        raise ValueError(f"levels = {given} m: must be finite")
    if not np.isfinite(number("stiffness", stiffness)):
        raise ValueError(f"stiffness = {stiffness} N/m: must be finite")
    if len(recording.stretches) > 1:
        part = max(recording.stretches, key=lambda rows: rows.stop - rows.start)
        target, used = target.cut(recording, part)
        recording, levels = recording.rows(part), levels[list(used)]
    found = densities(recording, target, levels)
    d, tiny = found.density, 1e-300
    xx = d[0, 0].real
    xf = d[0, 2] + stiffness * d[0, 3]  # -F + K0 X0 = Z x
    ff = d[2, 2].real + 2 * stiffness * d[2, 3].real + stiffness**2 * d[3, 3].real
    tf, tx = d[3, 2] + stiffness * d[3, 3], d[3, 0]
    return Response(
        frequency=found.frequency,
        stiffness=xf / (xx + tiny),
        by_target=tf / np.where(np.abs(tx) > tiny, tx, np.nan) if found.moving else None,
        coherence=np.clip(np.abs(xf) ** 2 / (xx * ff + tiny), 0, 1),
        motion=xx,
        segments=found.segments,
    )


def guess_by_response(recording: Recording, target: Target, levels: Values) -> Values | None:
    """Return M0, B0, K0 from the spectra, or None when they do not determine them.

    Eq. (4) line by line, seen through the target where it moves and through the motion otherwise: that is linear in
    the three. Lines weigh by how much of the force follows.
    """
    found = densities(recording, target, levels)
    d, s = found.density, 2j * np.pi * found.frequency
    r = found.seen_through
    columns = np.array([s**2 * d[r, 0], s * d[r, 0], d[r, 1]])
    coherence = np.abs(d[r, 2]) ** 2 / (d[r, r].real * d[2, 2].real + 1e-300)
    coherent = coherence > 0.5
    if coherent.sum() < 3:
        return None
    size = np.sqrt(d[r, r].real * d[2, 2].real * np.maximum(1 - coherence, 1e-4))
    A = (columns / size)[:, coherent]
    y = (d[r, 2] / size)[coherent]
    rows = np.hstack([A.real, A.imag]).T
    scale = np.sqrt((rows**2).sum(axis=0)) + 1e-300
    values, *_ = np.linalg.lstsq(rows / scale, np.concatenate([y.real, y.imag]), rcond=1e-10)
    return np.asarray(values / scale)
