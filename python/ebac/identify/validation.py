"""Validate a model: predict the motion from the force alone; test whether the residuals are white."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac.identify import motor_check
from ebac.identify.intervals import Z95, loose_inverse, normal_tail
from ebac.identify.parameters import BEFORE_LEVELS, HAND, kind
from ebac.identify.plausible import is_hand, without_place
from ebac.identify.rows import MANY

if TYPE_CHECKING:
    from ebac.identify.recording import Recording
    from ebac.identify.result import ArmResult

#: How far errors are compared with each other and with the input [samples].
LAGS = 40


@dataclass(frozen=True, kw_only=True, eq=False)
class ResidualTests:
    """Correlation of the errors with themselves and with the force.

    `auto` and `cross` have the shape (LAGS,); without structure 95 % of them lie within +-`band`.
    """

    auto: NDArray[np.float64]
    cross: NDArray[np.float64]
    band: float
    whiteness_p: float
    independence_p: float

    @property
    def white(self) -> bool:
        """Whether autocorrelation is small, |r| < 0.1 at every lag, or not significant."""
        return self.whiteness_p > 0.01 or float(np.abs(self.auto).max()) < 0.1

    @property
    def independent(self) -> bool:
        """Whether the force explains nothing more of the errors, |r| < 0.1, or not significantly."""
        return self.independence_p > 0.01 or float(np.abs(self.cross).max()) < 0.1


#: Rows in which the filter settles, and how many must be left.
SETTLING, LEAST_READINGS = 5, 8


class TooFewReadings(ValueError):
    """A log with too few informative readings to test a fit on: the encoder count hardly changes."""


def enough(errors: NDArray[np.float64]) -> bool:
    """Return whether errors, shape (rows,), are enough to be tested."""
    return int(np.count_nonzero(errors)) - SETTLING >= LEAST_READINGS


def residual_tests(
    errors: NDArray[np.float64], force: NDArray[np.float64], *, name: str
) -> ResidualTests:
    """Test the errors of one recording, shape (rows,), against themselves and the force [N].

    Raises
    ------
    TooFewReadings
        When too few rows are informative; the message begins with the `name` of the recording.
    """
    informative = np.flatnonzero(errors)  # rows with a reading
    if not enough(errors):
        raise TooFewReadings(
            f"{name}: {informative.size} informative readings, at least {SETTLING + LEAST_READINGS} are needed: "
            "the encoder count hardly changes, so this log does not determine the hand; record one with more motion"
        )
    informative = informative[SETTLING:]
    e = errors[informative] - errors[informative].mean()
    u = np.diff(force[informative], prepend=force[informative[0]])
    u = u - u.mean()
    n = len(e)
    lags = min(LAGS, n // 4)
    own = float(e @ e) + 1e-300
    auto = np.array([e[k:] @ e[: n - k] / own for k in range(1, lags + 1)])
    both = np.sqrt(own * (float(u @ u) + 1e-300))
    cross = np.array([e[k:] @ u[: n - k] / both for k in range(lags)])
    return ResidualTests(
        auto=auto,
        cross=cross,
        band=1.96 / np.sqrt(n),
        whiteness_p=_chi_square_tail(n * float(auto @ auto), lags),
        independence_p=_chi_square_tail(n * float(cross @ cross), lags),
    )


def _chi_square_tail(q: float, degrees: int) -> float:
    """Return the probability of a chi-square beyond q, by Wilson and Hilferty's cube root."""
    k = float(degrees)
    z = ((q / k) ** (1 / 3) - (1 - 2 / (9 * k))) / np.sqrt(2 / (9 * k))
    tail = 0.5 * normal_tail(float(z))
    return tail if z > 0 else 1 - tail


def vaf(measured: NDArray[np.float64], model: NDArray[np.float64]) -> float:
    """Return the variance accounted for, 1 - var(error)/var(measured); 1 is perfect."""
    return 1 - float(np.var(measured - model) / np.var(measured))


def nrmse(measured: NDArray[np.float64], model: NDArray[np.float64]) -> float:
    """Return the root of the mean squared error over the range of what was measured."""
    return float(np.sqrt(np.mean((measured - model) ** 2)) / np.ptp(measured))


def best_start(
    record: Any, theta: NDArray[np.float64], x: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Simulate a hand under a recorded force from the initial state that fits best."""
    none = record.simulate(theta, 0.0, 0.0)
    parts = np.array([record.simulate(theta, *z) - none for z in ((1.0, 0.0), (0.0, 1.0))])
    return np.asarray(none + _explained(parts, x - none))


def best_levels(
    record: Any, base: NDArray[np.float64], x: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Simulate as `best_start`, with the target's levels fitted too."""
    none = record.simulate(base, 0.0, 0.0)
    moves = [record.simulate(base, *z) - none for z in ((1.0, 0.0), (0.0, 1.0))]
    for j in range(BEFORE_LEVELS, len(base)):
        other = base.copy()
        other[j] += 1.0
        moves.append(record.simulate(other, 0.0, 0.0) - none)
    return np.asarray(none + _explained(np.array(moves), x - none))


def _explained(columns: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return what some columns, shape (columns, rows), explain of y by least squares; not by BLAS, see `search`."""
    scale = np.sqrt(np.einsum("ik,ik->i", columns, columns)) + 1e-300
    inverse = loose_inverse(np.einsum("ik,jk->ij", columns, columns) / np.outer(scale, scale))
    share = inverse @ (np.einsum("ik,k->i", columns, y) / scale) / scale
    return np.asarray(np.einsum("i,ik->k", share, columns))


@dataclass(frozen=True, kw_only=True)
class Prediction:
    """How well the hand predicts a recording from its force alone: 1 and 0 are perfect."""

    recording: str
    held_out: bool
    vaf: float
    nrmse: float


def judge(r: Recording, model: NDArray[np.float64], *, held: bool) -> Prediction:
    """Return how well a model's position [m] is that of a recording."""
    return Prediction(recording=r.name, held_out=held, vaf=vaf(r.x, model), nrmse=nrmse(r.x, model))


#: Errors correlated by more are those of a log that was changed: right ones reach 0.45 at 1 kHz, 0.62 at 100 Hz.
FAR = 0.7
#: A hand that explains less of the motion than this is questioned.
POOR = 0.8


def seems_flipped(explained: float, other_sign: float | None) -> bool:
    """Return whether a model explains a log well with the force of the other sign only."""
    return other_sign is not None and other_sign > max(POOR, explained)


#: With the right sign a hand, and with the wrong one the device, explains more of the motion than this; with a target
#: that is not the right one neither sign does: up to 0.77 in logs of hands that tap (tests/recordings/metronome.py).
SURE = 0.9


def share_text(explained: float) -> str:
    """Return a share of the motion (VAF) in words: "97.7 %"; below none the number says nothing."""
    return f"{100 * explained:.3g} %" if explained >= 0 else "less than nothing"


#: What turning a force means, by what is turned.
TURNED = {
    "force": "the force on the hand instead of the force of the hand",
    "motor": "the force that the motor drives to +x with instead of the force it resists with",
}


def flip_advice(sentence: str, explained: float, other_sign: float, turned: str = "force") -> str:
    """Return what to do about forces of the other sign; {} of the sentence is the share explained.

    `turned` names them: "force", "motor", or "force and motor".
    """
    names = turned.split(" and ")
    options = " and ".join(f"--flip-{name}" for name in names)
    words = {"force": "the force", "motor": "the motor's force"}
    other = " and ".join(words[n] for n in names)
    return (
        f"{sentence.format(share_text(explained))}; with {other} of the other sign "
        f"{100 * other_sign:.3g} %: the log seems to hold {', and '.join(TURNED[n] for n in names)}. {options} "
        f"{'turns the sign (leave it' if len(names) == 1 else 'turn the signs (leave the one'} out that was given), "
        f"in Python load(..., {', '.join(f'flip_{n}=True' for n in names)})."
    )


def misses(result: ArmResult) -> tuple[str, ...]:
    """Return what the model misses, a sentence each; nothing where structure in the errors changes no result."""
    checks = (_explains_little, _tied_to_no_place, _unusual, _late, _coloured)
    found = tuple(sentence for check in checks for sentence in check(result))
    if not found and not result.nothing_determined:
        found = tuple(_far_from_white(result))
    return found + tuple(_rows_missing(result))


def _explains_little(result: ArmResult) -> Iterator[str]:
    """Give what the hand leaves unexplained, or explains with the other sign."""
    if result.flip == "fit" and result.other_sign is not None:
        yield (
            flip_advice(
                "The hand explains {} of the motion (VAF)", result.explained, result.other_sign
            )
        )
    elif result.flip:
        yield (
            "Motion and force follow the target as those of a hand only with the force of the other sign: --flip-force "
            "turns it, in Python load(..., flip_force=True). A fit to that force does not determine the hand either: "
            "record one with more motion."
        )
    elif result.explained < POOR:
        share = (
            f"explains only {share_text(result.explained)} of the motion (VAF)"
            if result.explained >= 0
            else "explains less of the motion than none would (VAF below 0)"
        )
        yield (
            f"The hand {share}: is the target of the hand the right one (--switch with the time of every step, "
            "--tapping, or the column target)?"
        )


def _tied_to_no_place(result: ArmResult) -> Iterator[str]:
    """Give that the hand has no stiffness."""
    shown = max(result.explained, result.other_sign or 0.0) > SURE
    if shown and without_place(result.parameters, result.values, Z95 * result.deviation):
        yield (
            "The hand has no stiffness, so nothing ties it to a place: this is the device, or what it renders, seen "
            "with the force of the other sign. --flip-force turns it, in Python load(..., flip_force=True); "
            "ebac identify device estimates the device."
        )


def _unusual(result: ArmResult) -> Iterator[str]:
    """Give what makes the motor or the hand doubtful."""
    if not (result.flip or result.nothing_determined):
        yield from motor_check.doubts(result.recordings)
        if not is_hand(result.parameters, result.values):
            yield (
                "No arm or hand is like that: usual are 0.01 to 10 kg, 0.2 to 300 N s/m, 10 to 2e4 N/m. Are the "
                "units of x and force right (--unit x=mm)?"
            )


def _late(result: ArmResult) -> Iterator[str]:
    """Give a force or target that was late; of a hand that explains nothing, something else is wrong first."""
    if result.late and not result.flip and result.explained >= 0:
        p = result.parameters
        other = ", ".join(
            f"{name} = {float(result.late.values[p.names.index(name)]):.4g} {e.unit} instead of {e.value:.4g}"
            for name, e in result.estimates.items()
            if kind(name) in HAND and not e.fixed
        )
        yield (
            f"{result.late.sentence}, which the log was not said to be: with that, the fit gives {other}, and "
            f"-2 log L is lower by {result.late.gain:.3g}. {result.late.remedy} takes it into account. The intervals "
            "hold both values."
        )


def _coloured(result: ArmResult) -> Iterator[str]:
    """Give what differs below 20 Hz."""
    if result.regression:
        other = ", ".join(
            f"{name} = {value:.4g} {result[name].unit} instead of {result[name].value:.4g}"
            for name, value in result.regression.items()
        )
        yield (
            f"The errors are not white, and below 20 Hz the log gives {other}: something in the log, such as a filter "
            "or the lag of the force sensor, is not in eq. (4). The intervals hold both values."
        )


def _far_from_white(result: ArmResult) -> Iterator[str]:
    """Give how far the errors are from white, where nothing else says what is wrong."""
    far = max(float(np.abs(t.auto).max()) for t in result.tests.values())
    if far > FAR:
        yield (
            f"The errors are far from white, with an autocorrelation of {far:.2f}: something in the log, such as a "
            "position or a force that was filtered, or read less often, is not in eq. (4). The estimates may be off by "
            "more than their intervals: record position and force as they were read, at one rate."
        )


def _rows_missing(result: ArmResult) -> Iterator[str]:
    """Give of which recordings so many rows are missing that the intervals do not contain the truth."""
    for r in result.recordings:
        if r.missing > MANY:
            yield (
                f"{r.name}: {100 * r.missing:.0f} % of the rows are missing, more than {100 * MANY:.0f} %: the "
                "intervals are too narrow. Record every row."
            )
