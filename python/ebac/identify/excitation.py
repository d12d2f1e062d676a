"""Excitation signals: steps, chirps, multisines, tapping."""

from __future__ import annotations

import numpy as np

from ebac._core import Recorded
from ebac._util.arguments import number, whole
from ebac._util.arrays import Values
from ebac._util.wrong_calls import plain_function


def _times(amplitude: float, seconds: float, dt: float) -> Values:
    if not np.isfinite(number("amplitude", amplitude)):
        raise ValueError(f"amplitude = {amplitude}: must be finite")
    if not (number("dt", dt) > 0 and 2 * dt <= number("seconds", seconds) < np.inf):
        raise ValueError(
            f"seconds = {seconds} s, dt = {dt} s: need at least two steps of a positive time"
        )
    return np.asarray(dt * np.arange(round(seconds / dt) + 1))


@plain_function
def steps(
    amplitude: float, *, seconds: float = 10.0, hold: float = 1.0, dt: float = 1e-3
) -> tuple[Values, Values]:
    """Return times [s] and a square wave between 0 and `amplitude`, each level held for `hold` [s]."""
    t = _times(amplitude, seconds, dt)
    if not number("hold", hold) >= dt:
        raise ValueError(f"hold = {hold} s: must be at least one step, {dt} s")
    level: Values = np.floor(t / hold + 1e-9) % 2
    return t, amplitude * level


@plain_function
def tapping(
    amplitude: float, frequency: float, *, seconds: float = 10.0, dt: float = 1e-3
) -> tuple[Values, Values]:
    """Return times [s] and a square wave of `frequency` [Hz] between `amplitude` and 0."""
    t = _times(amplitude, seconds, dt)
    _below_nyquist(frequency, dt)
    return t, amplitude * ((frequency * t) % 1 < 0.5).astype(float)


@plain_function
def chirp(
    amplitude: float,
    *,
    low: float = 0.2,
    high: float = 20.0,
    seconds: float = 10.0,
    dt: float = 1e-3,
) -> tuple[Values, Values]:
    """Return times [s] and a sine whose frequency rises from `low` to `high` [Hz] at a constant rate in octaves."""
    t = _times(amplitude, seconds, dt)
    _band(low, high, dt)
    rate = np.log(high / low) / seconds
    return t, amplitude * np.sin(2 * np.pi * low / rate * np.expm1(rate * t))


@plain_function
def multisine(
    amplitude: float,
    *,
    low: float = 0.2,
    high: float = 10.0,
    seconds: float = 10.0,
    dt: float = 1e-3,
    seed: int = 1,
    tries: int = 60,
) -> tuple[Values, Values]:
    """Return times [s] and the sum of all harmonics of 1/`seconds` in [low, high] Hz, with the peak `amplitude`.

    The phases are those of Schroeder (1970), or the best of `tries` small changes of them. The crest factor, peak over
    root mean square, is below 2.
    """
    t = _times(amplitude, seconds, dt)
    _band(low, high, dt)
    lines = np.arange(max(1, int(np.ceil(low * seconds))), int(np.floor(high * seconds)) + 1)
    if lines.size == 0:
        raise ValueError(
            f"no multiple of {1 / seconds:.3g} Hz lies in [{low:g}, {high:g}] Hz: record longer"
        )
    k = np.arange(lines.size)
    phase = -np.pi * k * (k - 1) / lines.size
    draw = np.random.Generator(np.random.PCG64(whole("seed", seed)))
    waves = 2 * np.pi * np.outer(lines / seconds, t)

    # Two products show which phases are best, in a sixth of the time; their last digits are not those of the wave.
    cosines, sines = np.cos(waves), np.sin(waves)

    def tried(p: Values) -> float:
        return crest(np.einsum("k,kt", np.cos(p), cosines) - np.einsum("k,kt", np.sin(p), sines))

    lowest, at = tried(phase), phase
    for _ in range(whole("tries", tries)):
        trial = at + 0.3 * draw.standard_normal(lines.size)
        if (peak := tried(trial)) < lowest:
            lowest, at = peak, trial
    best = np.cos(waves + at[:, None]).sum(axis=0)
    return t, amplitude * best / np.abs(best).max()


def crest(values: Values) -> float:
    """Return the crest factor, peak over root mean square; 1.41 for a sine."""
    return float(np.abs(values).max() / np.sqrt(np.mean(values**2)))


def path(t: Values, x: Values) -> Recorded:
    """Return a signal [m] as the intended path of a hand."""
    return Recorded(t=np.asarray(t).tolist(), x=np.asarray(x).tolist())


def _below_nyquist(frequency: float, dt: float) -> None:
    if not 0 < number("frequency", frequency) < 0.5 / dt:
        raise ValueError(f"frequency = {frequency} Hz: must lie in (0, {0.5 / dt:g}) Hz")


def _band(low: float, high: float, dt: float) -> None:
    if not 0 < number("low", low) < number("high", high) < 0.5 / dt:
        raise ValueError(
            f"low = {low} Hz, high = {high} Hz: must lie in (0, {0.5 / dt:g}) Hz, low first"
        )
