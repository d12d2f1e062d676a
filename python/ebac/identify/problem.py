"""The objective of an arm: eq. (4) over several recordings, moved in C++."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import sqrt
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ebac._core import ArmGains, ArmRecord
from ebac.identify import unrecorded_motor
from ebac.identify.arm_record import arm_record
from ebac.identify.doubt import BEND, DELAY, DELAY_DRIVEN, WITHIN_TICK, Doubt, doubt_of
from ebac.identify.parameters import INPUTS, STEPS, Parameters, kind
from ebac.identify.recording import Recording
from ebac.identify.signals import Fold, by_target, rough
from ebac.identify.target import Target

#: Steps of the differences, as a share of a value.
STEP_SHARE = 1e-5

#: Hands a recording to the core.
Make: TypeAlias = Callable[[Recording, Target], ArmRecord]


@dataclass(frozen=True, kw_only=True, eq=False)
class Problem:
    """Errors of one tick ahead, each over its deviation, as a function of the free parameters."""

    recordings: tuple[Recording, ...]
    targets: tuple[Target, ...]
    parameters: Parameters
    make: Make = field(default_factory=lambda: arm_record)
    folds: tuple[Fold | None, ...] | None = None  # by default as the targets repeat
    drift: float = 0.0  # N/sqrt(s), of every force reading
    doubt: Doubt = field(init=False)  # moves with the search
    unseen: Doubt = field(init=False)  # does not, but widens the intervals

    def __post_init__(self) -> None:
        """Hand the recordings to the core."""
        self.records  # noqa: B018 - refuses what cannot be handed
        if self.folds is None:
            pairs = zip(self.recordings, self.targets, strict=True)
            object.__setattr__(self, "folds", tuple(by_target(r, target) for r, target in pairs))
        late = unrecorded_motor.deviations(self.recordings, self.parameters)
        moving = WITHIN_TICK | {name: deviation for name, deviation in late.items() if deviation}
        driven = {name: DELAY_DRIVEN for name, deviation in late.items() if not deviation}
        if not late:  # a device
            known = all(r.motor is not None for r in self.recordings)
            driven = {"delay": DELAY_DRIVEN if known else DELAY}
        object.__setattr__(self, "doubt", doubt_of(self, moving))
        object.__setattr__(self, "unseen", doubt_of(self, {"bend": BEND} | driven))
        object.__setattr__(self, "parameters", self._within_reach())

    @cached_property
    def records(self) -> tuple[ArmRecord, ...]:
        """The recordings in the core."""
        pairs = zip(self.recordings, self.targets, strict=True)
        return tuple(self.make(r, target) for r, target in pairs)

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what cannot be pickled, and is made again where it is asked for."""
        return {name: value for name, value in self.__dict__.items() if name != "records"}

    def _within_reach(self) -> Parameters:
        """Return the parameters, a delay in doubt bounded by as far off as it may be, in a uniform distribution."""
        p, low, high = self.parameters, self.parameters.low.copy(), self.parameters.high.copy()
        for i, deviation in zip(self.doubt.which, self.doubt.deviation, strict=True):
            if kind(p.names[i]) == "delay":
                low[i], high[i] = p.fixed[i] + sqrt(3) * deviation * np.array([-1, 1])
        return replace(p, low=low, high=high)

    def drifting(self, drift: float) -> Problem:
        """Return the same with another drift of the force [N/sqrt(s)]."""
        out = copy(self)
        out.__dict__.update(drift=drift, records=self.records)  # nothing of them depends on it
        return out

    def wander(self, drift: float) -> tuple[float, float]:
        """Return a drift, and within which force it begins [N]: what it comes to over all recordings."""
        start, end = (f(r.t[i] for r in self.recordings) for f, i in ((min, 0), (max, -1)))
        return drift, drift * float(np.sqrt(end - start))

    @cached_property
    def shown(self) -> NDArray[np.float64]:
        """Return the least noise of each force that is believed [N]: what its signal shows, never none."""
        forces = [r.force for r in self.recordings if r.force is not None]
        return np.array([max(rough(f), 1e-5 * float(np.ptp(f)), 1e-9) for f in forces])

    def gains(
        self, values: NDArray[np.float64], force_noise: NDArray[np.float64]
    ) -> list[ArmGains]:
        """Return the filters made for a guess and a noise of the force [N], one for each recording.

        What is in doubt within a tick stays where it is held: the row a jump falls into must not flicker.
        """
        held = self.held(values)
        return [
            record.gains(held[place], float(noise), *self.wander(self.drift))
            for record, place, noise in zip(
                self.records, self.parameters.places, force_noise, strict=True
            )
        ]

    def held(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return values with what is in doubt where it is held."""
        out = values.copy()
        out[self.doubt.which] = self.parameters.fixed[self.doubt.which]
        return out

    def errors(self, values: NDArray[np.float64], gains: list[ArmGains]) -> NDArray[np.float64]:
        """Return the errors of all recordings, one after the other."""
        parts = zip(self.records, self.parameters.places, gains, strict=True)
        return np.concatenate([r.innovations(values[place], g) for r, place, g in parts])

    @property
    def moved(self) -> NDArray[np.intp]:
        """Indices of what a search moves: the free parameters, then those in doubt."""
        return np.concatenate([self.parameters.free, self.doubt.which])

    def parameters_within(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return values within their bounds; what is held for sure stays."""
        return np.asarray(np.clip(values, self.parameters.low, self.parameters.high))

    def objective(self, values: NDArray[np.float64], gains: list[ArmGains]) -> NDArray[np.float64]:
        """Return the errors, then how far each parameter in doubt lies from where it is held, in deviations."""
        doubt = self.doubt
        off = (values[doubt.which] - self.parameters.fixed[doubt.which]) / doubt.deviation
        return np.concatenate([self.errors(values, gains), off])

    def linearised(
        self, values: NDArray[np.float64], gains: list[ArmGains]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return objective, and d objective / d moved, shape (moved, rows + doubts)."""
        doubts = len(self.doubt.which)
        return self._with_doubts(
            values, *self._linearised(self.records, values, gains, self.moved, doubts)
        )

    def _with_doubts(
        self, values: NDArray[np.float64], errors: NDArray[np.float64], inner: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Put in how far each parameter in doubt lies from where it is held."""
        doubt, free = self.doubt, len(self.parameters.free)
        rows = len(errors) - len(doubt.which)
        errors[rows:] = (values[doubt.which] - self.parameters.fixed[doubt.which]) / doubt.deviation
        inner[free:, rows:] = np.diag(1 / doubt.deviation)
        return errors, inner

    def slope(self, values: NDArray[np.float64], gains: list[ArmGains]) -> NDArray[np.float64]:
        """Return d objective / d moved, shape (moved, rows + doubts)."""
        return self.linearised(values, gains)[1]

    def renewed(
        self, values: NDArray[np.float64], force_noise: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the same as `linearised`, with the filters made anew for each change of a free parameter."""
        doubt, held = self.doubt, self.held(values)

        def look(
            i: int, which: list[int], more: int
        ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
            place, known = self.parameters.places[i], [force_noise[i], *self.wander(self.drift)]
            steps = [self._step(int(place[w]), values) for w in which]
            kept = sum(int(place[w]) in doubt.which for w in which)
            return self.records[i].renewed(
                values[place], held[place], known, which, kept, steps, more
            )

        return self._with_doubts(values, *self._gathered(look, self.moved, len(doubt.which)))

    def jacobian(
        self,
        values: NDArray[np.float64],
        gains: list[ArmGains],
        wanted: NDArray[np.intp] | None = None,
    ) -> NDArray[np.float64]:
        """Return d errors / d parameters, shape (parameters, rows); by default of the free ones."""
        chosen = self.parameters.free if wanted is None else wanted
        return self._linearised(self.records, values, gains, chosen)[1]

    def of_noise(
        self,
        values: NDArray[np.float64],
        gains: list[ArmGains],
        force_noise: NDArray[np.float64],
        wanted: NDArray[np.intp],
        seed: int = 0,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return Jacobian and errors of a log in which nothing but noise of the force moves a resting hand.

        Its apparent information on the parameters is that of noise.
        """
        draw = np.random.Generator(np.random.PCG64(seed))
        still = values.copy()
        for place in self.parameters.places:
            still[place[self.parameters.before_levels :]] = 0.0
        records = tuple(
            record.resting(noise * draw.standard_normal(len(r.t)))
            for record, r, noise in zip(
                self.records, self.recordings, force_noise.tolist(), strict=True
            )
        )
        noiseless = ("X0", "onset", *INPUTS)  # a target is known without noise
        doubtful = set(self.doubt.which.tolist())  # nor does a delay change how noise moves a hand
        places = [
            kind(self.parameters.names[i]) not in noiseless and i not in doubtful for i in wanted
        ]
        out = np.zeros((len(wanted), sum(len(r.t) for r in self.recordings)))
        errors, out[places] = self._linearised(records, still, gains, wanted[places])
        return out, errors

    def _linearised(
        self,
        records: tuple[ArmRecord, ...],
        values: NDArray[np.float64],
        gains: list[ArmGains],
        chosen: NDArray[np.intp],
        more: int = 0,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return errors and Jacobian of all recordings, one after the other, and `more` zeros behind them."""

        def look(
            i: int, which: list[int], more: int
        ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
            theta = values[self.parameters.places[i]]
            return records[i].linearised(theta, gains[i], which, more)

        return self._gathered(look, chosen, more)

    def _gathered(
        self,
        look: Callable[[int, list[int], int], tuple[NDArray[np.float64], NDArray[np.float64]]],
        chosen: NDArray[np.intp],
        more: int,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return errors and Jacobian by `chosen`; `look` gives those of a recording by what of its own is wanted."""
        if len(self.recordings) == 1:
            index = {f: w for w, f in enumerate(self.parameters.places[0].tolist())}
            return look(0, [index[f] for f in chosen.tolist()], more)
        rows = sum(len(r.t) for r in self.recordings) + more
        out, errors = np.zeros((len(chosen), rows)), np.zeros(rows)
        start = 0
        for k, (place, r) in enumerate(zip(self.parameters.places, self.recordings, strict=True)):
            index = {f: w for w, f in enumerate(place.tolist())}
            mine = [(i, index[f]) for i, f in enumerate(chosen.tolist()) if f in index]
            part = slice(start, start + len(r.t))
            errors[part], columns = look(k, [w for _, w in mine], 0)
            for (i, _), column in zip(mine, columns, strict=True):
                out[i, part] = column
            start = part.stop
        return errors, out

    def _step(self, index: int, values: NDArray[np.float64]) -> float:
        least = STEPS[kind(self.parameters.names[index])]
        return max(STEP_SHARE * abs(float(values[index])), least)
