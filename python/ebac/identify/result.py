"""Result of a fit of an arm: estimates, intervals and tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Hand, Recorded, Step
from ebac._util.arguments import named, require, shown, whole
from ebac.identify import arm_shown, informativeness, limits, unrecorded_motor, validation
from ebac.identify.arm_record import arm_record
from ebac.identify.estimate import Estimate
from ebac.identify.intervals import Z95
from ebac.identify.late_force import Late
from ebac.identify.parameters import BEFORE_LEVELS, HAND, OWN, Parameters, kind
from ebac.identify.problem import Problem
from ebac.identify.recording import Recording
from ebac.identify.recording_list import require_recordings
from ebac.identify.target import Target, longest, require_target
from ebac.identify.validation import (
    Prediction,
    ResidualTests,
    best_levels,
    best_start,
    enough,
    judge,
    residual_tests,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Of the way of a log: from here on the handle moves.
STIRS = 0.02


@dataclass(frozen=True, kw_only=True, eq=False)
class ArmResult:
    """The identified arm of eq. (4); pass `result.hand` to a `Scenario`."""

    problem: Problem
    values: NDArray[np.float64]
    optimum: NDArray[np.float64]  # of the search, before the noise of the input is taken off
    force_noise: NDArray[np.float64]
    errors: NDArray[np.float64]
    covariance: NDArray[np.float64]
    robust: float | None
    converged: bool
    evaluations: int
    seconds: float
    #: M0, B0, K0 of a regression that contradicts the fit; the intervals hold both.
    regression: Mapping[str, float] = field(default_factory=dict)
    #: A delay or a lag of the force that makes the log clearly likelier; the intervals hold the values with it, too.
    late: Late | None = None
    #: VAF of a fit to the force of the other sign, where this one explains little or determines nothing of the hand.
    other_sign: float | None = None
    #: What says that the force has the other sign: "fit", "spectra", or "" for nothing.
    flip: str = ""

    @property
    def parameters(self) -> Parameters:
        """Names and bounds of the parameters, and which are free."""
        return self.problem.parameters

    @property
    def recordings(self) -> tuple[Recording, ...]:
        """The fitted recordings."""
        return self.problem.recordings

    @cached_property
    def deviation(self) -> NDArray[np.float64]:
        """Standard deviation of each parameter, 0 for fixed ones."""
        out = np.zeros(len(self.values))
        out[self.parameters.free] = np.sqrt(np.maximum(np.diag(self.covariance), 0))
        return out

    @cached_property
    def correlation(self) -> NDArray[np.float64]:
        """Correlations of the free parameters, shape (free, free)."""
        d = np.sqrt(np.maximum(np.diag(self.covariance), 1e-300))
        return np.asarray(self.covariance / np.outer(d, d))

    @cached_property
    def _span(self) -> float:
        return max(float(np.ptp(r.x)) for r in self.recordings)

    @cached_property
    def undetermined(self) -> tuple[str, ...]:
        """Names of the parameters that this log does not determine."""
        half = Z95 * self.deviation
        dt = max(r.dt for r in self.recordings)
        if self.impossible:
            return tuple(self.parameters.names[i] for i in self.parameters.free)
        return informativeness.undetermined(
            self.parameters, self.values, half, self.correlation, self._span, dt
        )

    @cached_property
    def nothing_determined(self) -> bool:
        """Whether the log determines none of M0, B0 and K0 that was to be fitted."""
        names = [self.parameters.names[i] for i in self.parameters.free]
        hand = {name for name in names if kind(name) in HAND}
        return bool(hand) and hand.issubset(self.undetermined)

    @cached_property
    def impossible(self) -> tuple[str, ...]:
        """Why the estimates are no result, one sentence each: the model explains less of the motion than no model."""
        if self.explained >= 0:
            return ()
        return ("the hand explains less of the motion than none would (VAF below 0)",)

    @cached_property
    def inseparable(self) -> tuple[tuple[str, str, float], ...]:
        """Pairs of parameters that this log cannot separate, with their correlation."""
        half = Z95 * self.deviation
        return informativeness.inseparable(
            self.parameters, self.values, half, self.correlation, self._span
        )

    @cached_property
    def estimates(self) -> dict[str, Estimate]:
        """Every parameter by name."""
        out = {}
        free = set(self.parameters.free.tolist())
        for i, name in enumerate(self.parameters.names):
            given = i not in free and kind(name) == "delay"  # what a motor adds to it is in `notes`
            value = float((self.parameters.fixed if given else self.values)[i])
            half = Z95 * float(self.deviation[i])
            out[name] = Estimate(
                name=name,
                value=value,
                unit=self.parameters.unit(name),
                low=value - half,
                high=value + half,
                fixed=i not in free,
                determined=name not in self.undetermined,
            )
        return out

    @property
    def shown(self) -> tuple[Estimate, ...]:
        """Return the rows of a table: fitted parameters, and given parameters of the hand."""
        return tuple(e for e in self.estimates.values() if not e.fixed or kind(e.name) in HAND)

    def __getitem__(self, name: str) -> Estimate:
        """Return one parameter."""
        return named("parameter", name, self.estimates)

    @cached_property
    def tests(self) -> dict[str, ResidualTests]:
        """Whiteness and independence of the errors, by recording; of several, those with enough readings."""
        out, start = {}, 0
        for r in self.recordings:
            assert r.force is not None
            errors = self.errors[start : start + len(r.t)]
            start += len(r.t)
            if enough(errors) or len(self.recordings) == 1:
                out[r.name] = residual_tests(errors, r.force, name=r.name)
        return out

    @cached_property
    def misses(self) -> tuple[str, ...]:
        """What the model does not explain, one sentence each; empty if that changes no result."""
        return validation.misses(self)

    @property
    def notes(self) -> tuple[str, ...]:
        """Which missing information widens the intervals, one sentence each."""
        motor = unrecorded_motor.notes(self.recordings, self.parameters, self.values)
        return (*motor, *limits.notes(self.recordings))

    @cached_property
    def hand(self) -> Hand:
        """The hand of the first recording for a `Scenario`, with its last level as target.

        Raises
        ------
        ValueError
            When mass, damping or stiffness is not determined by the log.
        """
        lost = [n for n in self.undetermined if kind(n) in HAND]
        if lost:
            target = self.problem.targets[0]
            if self.flip:
                remedy = f". {self.misses[0]}"
            elif target.path is None and not target.switches:
                remedy = (
                    "; it was taken as held in one place. If it went to another, give the times, Target.steps(...) or "
                    "--switch; else record one with more excitation, or fix some of the values"
                )
            elif target.switches:
                r = self.recordings[0]
                moves = r.t[np.argmax(np.abs(r.x - r.x[0]) > STIRS * np.ptp(r.x))]
                times = ", ".join(f"{at:g}" for at in target.switches)
                remedy = (
                    f"; the target was taken to change at {times} s (Target.steps, --switch), and the handle first "
                    f"moves at {moves:.2f} s. Correct the times; if they are right, record a log with more "
                    "excitation, or fix some of the values"
                )
            else:
                remedy = "; record one with more excitation, or fix some of the values"
            raise ValueError(
                f"{', '.join(lost)}: not determined by this log, so there is no hand to simulate{remedy}"
            )
        theta = self.values[self.parameters.places[0]]
        target, r = self.problem.targets[0], self.recordings[0]
        path: Step | Recorded
        if target.path is not None:
            path = Recorded(t=r.t.tolist(), x=(target.path + theta[BEFORE_LEVELS]).tolist())
        else:
            path = Step(target=float(theta[BEFORE_LEVELS + target.segments[-1]]))
        return Hand(
            mass=float(theta[0]), damping=float(theta[1]), stiffness=float(theta[2]), path=path
        )

    def simulated(self, recording: int = 0) -> NDArray[np.float64]:
        """Return the position [m] simulated with this hand from a recording's force and the best initial state."""
        recording = self._index(recording)
        theta = self.values[self.parameters.places[recording]]
        r = self.recordings[recording]
        record = self.problem.records[recording]
        if self.drift and r.force is not None:
            record = arm_record(
                replace(r, force=r.force - self.drifts(recording)), self.problem.targets[recording]
            )
        return best_start(record, theta, r.x)

    def _index(self, recording: int) -> int:
        """Return the number of a recording that was fitted, counted from 0."""
        last = len(self.recordings) - 1
        if not 0 <= whole("recording", recording) <= last:
            raise ValueError(
                f"recording = {recording}: must lie in [0, {last}], the number of a recording that was fitted, counted "
                "from 0; predictions([(recording, target)]) takes others"
            )
        return recording

    @property
    def drift(self) -> float:
        """Estimated drift of the force [N/sqrt(s)]; 0 for none."""
        return self.problem.drift

    def drifts(self, recording: int = 0) -> NDArray[np.float64]:
        """Return the estimated error of a recording's force due to drift at each row [N]; positive: too high."""
        recording = self._index(recording)
        place = self.problem.parameters.places[recording]
        gains = self.problem.gains(self.values, self.force_noise)[recording]
        out = self.problem.records[recording].drifts(self.values[place], gains)
        return np.asarray(out)

    def predictions(
        self, held_out: Sequence[tuple[Recording, Target]] = ()
    ) -> tuple[Prediction, ...]:
        """Return how well the hand predicts its own recordings and others.

        For a recording that was not fitted, M0, B0, K0 and delay are kept; the target and the initial state are fitted.
        """
        rows = [judge(r, self.simulated(i), held=False) for i, r in enumerate(self.recordings)]
        wanted = "pairs (Recording, Target), such as [(recording, Target.held())]"
        require(held_out, Sequence, "ArmResult.predictions", wanted)
        pair: Any
        for pair in held_out:
            if not isinstance(pair, tuple) or len(pair) != 2:
                raise TypeError(f"ArmResult.predictions takes {wanted}, not {shown(pair)}")
            require_recordings(pair[0], "ArmResult.predictions")
            require_target(*pair, "ArmResult.predictions")
            r, target = longest(*pair)
            record = arm_record(r, target)
            hand = self.values[self.parameters.places[0]][:4]
            base = np.concatenate([hand, np.zeros(len(OWN) + target.levels)])
            rows.append(judge(r, best_levels(record, base, r.x), held=True))
        return tuple(rows)

    @cached_property
    def explained(self) -> float:
        """Smallest share of the motion of a recording (VAF) that this hand explains from the force alone."""
        return min(p.vaf for p in self.predictions())

    def profile(self, name: str, level: float = Z95**2) -> tuple[float, float]:
        """Return the 95 % interval of a parameter by profile likelihood: for each value all others are fitted again."""
        from ebac.identify.intervals import profile

        return profile(self, name, level)

    def plot(self) -> Figure:
        """Plot the fit, its errors, their correlations and the frequency response."""
        from ebac.identify.figures import plot_arm

        return plot_arm(self)

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers in SI units, for JSON."""
        return arm_shown.numbers(self)

    def _repr_html_(self) -> str:
        """Return the figure, the estimates and what to be careful about, for a notebook."""
        return arm_shown.page(self)

    def __repr__(self) -> str:
        """Return the estimates, one a line, and what to be careful about."""
        return arm_shown.text(self)
