"""Where a search for an arm starts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ebac._util.arrays import Values
from ebac.identify.guess import regression, solve
from ebac.identify.parameters import BEFORE_LEVELS, SHARED
from ebac.identify.problem import Problem
from ebac.identify.recording import Recording
from ebac.identify.response import guess_by_response


def better_guess(problem: Problem) -> Values:
    """Return the likelier one of two guesses: by regression over time, and by the spectra of the longest recording."""
    by_time = first_guess(problem)
    first = int(np.argmax([len(r.t) for r in problem.recordings]))
    place = problem.parameters.places[first]
    recording, target = _in_time(problem)[first], problem.targets[first]
    try:
        found = guess_by_response(recording, target, by_time[place[BEFORE_LEVELS:]])
    except ValueError:  # too short for spectra
        return by_time
    if found is None or not (found > 0).all():
        return by_time
    other = by_time.copy()
    other[place[:3]] = found
    other = problem.parameters.clip(other)
    noise, record = float(problem.shown[first]), problem.records[first]
    both = np.array([by_time[place], other[place]])
    costs = record.judge(both, both, [(noise, 0.0, 0.0)] * 2)
    return other if costs[1] < costs[0] else by_time


def first_guess(problem: Problem) -> Values:
    """Return where a search starts, by linear regression, within the bounds."""
    parts = [regression(r, t) for r, t in zip(_in_time(problem), problem.targets, strict=True)]
    found, _ = solve(parts)
    found = np.where(np.isfinite(found), found, 0.0)
    values = np.zeros(len(problem.parameters.names))
    positive = [(0.02, 5.0), (0.3, 100.0), (5.0, 5e3)]
    hand = [float(np.clip(v, *limits)) for v, limits in zip(found[:3], positive, strict=True)]
    before = 3
    for place, part, r in zip(problem.parameters.places, parts, problem.recordings, strict=True):
        count = part.columns.shape[1] - 3
        reach = float(np.abs(r.x).max()) + 0.5
        levels = np.clip(found[before : before + count], -reach, reach)
        values[place] = [*hand, *np.zeros(BEFORE_LEVELS - 3), *levels]
        before += count
    return problem.parameters.clip(values)


def _in_time(problem: Problem) -> list[Recording]:
    """Return the recordings with forces that are not late by the whole ticks of a delay that is held."""
    p = problem.parameters
    held = [np.nan_to_num(p.fixed[place[SHARED.index("delay")]]) for place in p.places]
    return [
        r if r.force is None else replace(r, force=advanced(r.force, round(float(late) / r.dt)))
        for r, late in zip(problem.recordings, held, strict=True)
    ]


def advanced(values: Values, rows: int) -> Values:
    """Return values that come some rows earlier; at the end the last one again."""
    if rows == 0:
        return values
    at = np.clip(np.arange(len(values)) + rows, 0, len(values) - 1)
    return np.asarray(values[at])
