"""Where a log repeats itself: rows whose errors are the same, so that more of them tell no more.

A hand that taps to a metronome passes the same counts at the same instants in every period, and each time the encoder
rounds alike. Such errors do not average out over the periods, and no test along time sees it. A log is therefore also
folded, so that what repeats lies on one another, and its scores are summed there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac.identify.recording import Recording
from ebac.identify.target import Target

Fold = NDArray[np.intp]


def by_target(recording: Recording, target: Target) -> Fold | None:
    """Return for each row how long its level has held, level after level [rows]; None when no level comes again."""
    segments = np.array(target.segments)
    if len(set(target.segments)) == len(segments):
        return None
    n, dt = len(recording.t), recording.dt
    switches = (np.array(target.switches) - recording.t[0]) / dt
    starts = np.concatenate([[0], np.ceil(switches - 1e-6)]).astype(int).clip(0, n)
    lengths = np.diff(np.append(starts, n))
    since = np.arange(n) - np.repeat(starts, lengths)
    return np.asarray(np.repeat(segments, lengths) * int(lengths.max()) + since, dtype=np.intp)


def by_place(recording: Recording, sign: NDArray[np.float64]) -> Fold | None:
    """Return for each row its count, first on the ways up, then on those down; None without counts.

    `sign` is that of the velocity. Where nobody says what the hand was asked to do, the same errors are those of the
    same count passed the same way.
    """
    if recording.count <= 0:
        return None
    place = np.round((recording.x - recording.x.min()) / recording.count).astype(np.intp)
    most = int(place.max()) + 1
    return np.asarray(np.where(sign >= 0, place, 2 * most - 1 - place), dtype=np.intp)


def folded(scores: NDArray[np.float64], fold: Fold) -> NDArray[np.float64]:
    """Return scores, shape (parameters, rows), summed where they lie on one another."""
    length = int(fold.max()) + 1
    return np.array([np.bincount(fold, weights=row, minlength=length) for row in scores])
