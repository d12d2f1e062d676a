"""First guess, and the unbiased second opinion: linear regression on smoothed signals.

Eq. (4) smoothed by one kernel h on every signal, h * F = -M0 h'' * x - B0 h' * x - K0 h * x + sum of K0 X0_j h * s_j,
is linear in what is sought. By least squares it is a good start. By instruments, signals that the target moves and
noise does
not, it is unbiased also in closed loop, where the law carries noise from one signal to the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.identify.intervals import newey_west
from ebac.identify.missing import force_of_hand
from ebac.identify.recording import Recording
from ebac.identify.signals import Fold, every, folded, kernels, smoothed
from ebac.identify.target import Target, indicators, lagged


@dataclass(frozen=True, kw_only=True, eq=False)
class Regression:
    """h * F = columns @ (-M0, -B0, -K0, K0 X0_1, ...), behind the lag of the sensor."""

    force: NDArray[np.float64]
    columns: NDArray[np.float64]  # (rows, 3 + levels)
    taps: int  # of the kernel, in rows of the recording
    step: int  # rows of the recording from one of these to the next


def regression(recording: Recording, target: Target) -> Regression:
    """Set the smoothed eq. (4) up.

    Raises
    ------
    ValueError
        When the recording has no force.
    """
    force = force_of_hand(recording)
    h, step = kernels(recording.dt), every(recording.dt)
    x = lagged(recording.x, recording.dt, recording.lag)
    moved = [smoothed(x, h[i], step) for i in (2, 1, 0)]
    if target.path is not None:
        moved[2] -= smoothed(lagged(target.path, recording.dt, recording.lag), h[0], step)
    levels = [smoothed(row, h[0], step) for row in indicators(recording, target)]
    return Regression(
        force=smoothed(force, h[0], step),
        columns=np.array([*moved, *levels]).T,
        taps=h.shape[1],
        step=step,
    )


def solve(
    regressions: list[Regression],
    instruments: list[NDArray[np.float64]] | None = None,
    folds: Sequence[Fold | None] = (),
) -> Any:
    """Return M0, B0, K0 and for each recording its levels, by least squares or by instruments.

    `folds` gives where the recordings repeat themselves, see `folds`.

    Returns
    -------
    values : array, shape (3 + all levels,)
    covariance : array
        Of the values, residual autocorrelation taken into account.
    """
    counts = [r.columns.shape[1] - 3 for r in regressions]
    width = 3 + sum(counts)
    blocks, before = [], 3
    for r, count in zip(regressions, counts, strict=True):
        block = np.zeros((len(r.force), width))
        block[:, :3] = r.columns[:, :3]
        block[:, before : before + count] = r.columns[:, 3:]
        blocks.append(block)
        before += count
    A, y = np.vstack(blocks), np.concatenate([r.force for r in regressions])
    Z = A if instruments is None else _projected(A, instruments, regressions)
    scale = np.sqrt(np.mean(A**2, axis=0)) + 1e-300
    A, Z = A / scale, Z / scale  # products of long columns not by BLAS, which waits for its threads
    left = np.linalg.pinv(np.einsum("ki,kj->ij", Z, A), rcond=1e-10)
    raw = left @ np.einsum("ki,k->i", Z, y)
    e = y - np.einsum("ki,i->k", A, raw)
    scores = Z * e[:, None]
    block_rows = max(regressions[0].taps // regressions[0].step, len(scores) // 60)
    ends = np.add.reduceat(scores, np.arange(0, len(scores), block_rows), axis=0)
    raw_cov = left @ (ends.T @ ends) @ left.T
    if any(fold is not None for fold in folds):
        raw_cov = _wider(raw_cov, left @ _repeated(scores.T, regressions, folds) @ left.T)
    k = raw[2] / scale[2]
    turn = np.ones(width) / scale
    turn[:3] *= -1
    values = raw * turn
    values[3:] /= max(-k, 1e-9)
    turn[3:] /= max(-k, 1e-9)
    return values, raw_cov * np.outer(turn, turn)


def _repeated(
    scores: NDArray[np.float64], parts: list[Regression], folds: Sequence[Fold | None]
) -> NDArray[np.float64]:
    """Return the long-run covariance of scores, shape (values, rows), along the folded recordings."""
    out, start = np.zeros((len(scores), len(scores))), 0
    for part, fold in zip(parts, folds, strict=True):
        rows, half = slice(start, start + len(part.force)), part.taps // 2
        mine = scores[:, rows]
        if fold is not None:
            mine = folded(mine, fold[half:-half][:: part.step] // part.step)
        out += newey_west(mine, reach=half // part.step)
        start = rows.stop
    return out


def _wider(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the first covariance, with the larger variances of both."""
    a, b = np.diag(first), np.diag(second)
    more = np.sqrt(np.maximum(b / np.maximum(a, 1e-300), 1.0))
    return np.asarray(first * np.outer(more, more))


def _projected(
    A: NDArray[np.float64], instruments: list[NDArray[np.float64]], parts: list[Regression]
) -> NDArray[np.float64]:
    """Return what of the columns the instruments explain: the first of the two stages."""
    out = A.copy()
    start = 0
    for Z, part in zip(instruments, parts, strict=True):
        rows = slice(start, start + len(part.force))
        scale = np.sqrt(np.einsum("ki,ki->i", Z, Z)) + 1e-300
        Z = Z / scale
        sizes, axes = np.linalg.eigh(np.einsum("ki,kj->ij", Z, Z))  # BLAS waits for its threads
        sizes[sizes < WEAK * sizes[-1]] = np.inf
        axes = axes / np.sqrt(sizes)
        Z = np.einsum("ki,ij->kj", Z, axes)
        out[rows] = np.einsum("ki,ij->kj", Z, np.einsum("ki,kj->ij", Z, A[rows]))
        start = rows.stop
    return out


#: Instruments of less than this share of the strongest one, in power, are noise [1].
WEAK = 1e-12
#: Longest delay of the target among the instruments [s], and their spacing.
MEMORY, SPACING = 0.6, 0.012


def instruments(recording: Recording, target: Target, taps: int) -> NDArray[np.float64] | None:
    """Return delayed copies of the target, shape (rows, instruments); None when the target never moves."""
    path = indicators(recording, target)[1:]
    if target.path is not None:
        path = np.vstack([path, target.path[None, :]])
    if path.size == 0 or not (np.ptp(path, axis=1) > 0).any():
        return None
    dt = recording.dt
    h = kernels(dt)[0]
    delays = np.round(np.arange(0, MEMORY, max(SPACING, dt)) / dt).astype(int)
    delays = delays[delays < path.shape[1]]
    rows, longest = len(recording.t) - taps + 1, int(delays[-1])
    columns = [np.ones(rows)]
    for row in path:
        late = smoothed(np.concatenate([np.full(longest, row[0]), row]), h)
        columns += [late[longest - d :][:rows] for d in delays.tolist()]
    return np.array([column[:: every(dt)] for column in columns]).T
