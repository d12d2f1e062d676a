"""K_p and K_d of eq. (2), chosen on the loop of a log."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ebac._core import Hand, Linear
from ebac._util.arguments import nearest_float, require
from ebac._util.wrong_calls import plain_function
from ebac.identify.gains.press_trials import arms_around, force_loop_laws, noise_gain
from ebac.identify.gains.search import MOST_EVALUATIONS, RESOLVED, GainsSearch
from ebac.identify.gains.trial import Candidate, Limits, allowances
from ebac.identify.loop import DEPTH, LoopModel
from ebac.laws import Variant, design
from ebac.scenario import Scenario

#: Why no gains are chosen for a device without a force sensor, and what to do.
NO_SENSOR = (
    "the device has no force sensor, which a force loop needs: its gains kp and kd feed back a measured force. Leave "
    "out fitted = false in [device.sensor] if the device has one (in a configuration of `ebac run` add [sensor]); "
    "without one, laws run on the encoder alone, and there are no gains to choose"
)
#: How deep every hand presses [m].
DEPTHS = (DEPTH, 0.5 * DEPTH)


@dataclass(frozen=True, kw_only=True, eq=False)
class GainsResult:
    """Gains chosen for a loop; `result.law` runs in any `Scenario`.

    `turned_down` is the largest share of the default gains, in tenths, that keeps all constraints with a margin; None
    if the default itself keeps them, or no share of it does.
    """

    loop: LoopModel
    name: str
    hands: tuple[Hand, ...]
    limits: Limits
    chosen: Candidate
    default: Candidate
    turned_down: Candidate | None
    rules: tuple[Candidate, ...]
    tried: tuple[Candidate, ...]

    @property
    def kp(self) -> float:
        """K_p of eq. (2) [1]."""
        return self.chosen.kp

    @property
    def kd(self) -> float:
        """K_d of eq. (2) [s]."""
        return self.chosen.kd

    @property
    def law(self) -> Variant:
        """The law with these gains, designed for the device it runs on."""
        return Variant(self.name, {"kp": self.kp, "kd": self.kd})

    @property
    def scenario(self) -> Scenario:
        """The scenario of the loop for which the gains were chosen."""
        return self.loop.scenario

    def rows(self) -> list[dict[str, Any]]:
        """Return one row each for the default gains, the rules and the chosen gains."""
        return [c.row() for c in (self.default, *self.rules, self.chosen)]

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers in SI units, for JSON."""
        return {
            "rows": self.rows(),
            "law": self.name,
            "kp": self.kp,
            "kd_s": self.kd,
            "limits": vars(self.limits),
            "hands": len(self.hands),
            "presses": len(self.chosen.presses.goals),
            "tried": [
                {"kp": c.kp, "kd_s": c.kd, "cost": c.cost, "broken": list(c.broken)}
                for c in self.tried
            ],
            "remarks": list(self.loop.remarks),
        }

    def _repr_html_(self) -> str:
        """Return the figure and default, rules and choice, for a notebook."""
        from ebac._util import notebook
        from ebac.identify.figures import plot_gains

        return notebook.result(repr(self), self.rows(), lambda: plot_gains(self))

    def __repr__(self) -> str:
        """Return the choice and its results."""
        n = self.chosen.presses.numbers()
        return (
            f"<Gains of {self.name}: kp = {self.kp:.3g}, kd = {1e3 * self.kd:.3f} ms; settles in "
            f"{n['settled_median_s']:.3g} s, swings {1e3 * n['swing_worst_m']:.3g} mm at most, cost "
            f"{self.chosen.cost:.3g}, of the default 1>"
        )


def buys_nothing(result: GainsResult) -> bool:
    """Return whether the law without force loop keeps all that the choice keeps, and settles, swings and sounds alike.

    Alike is what the cost cannot resolve: half a tick of settling, a hundredth of swing and noise.
    """
    chosen = result.chosen
    alike = allowances(result.default.presses, result.scenario)
    return any(
        one.kp == one.kd == 0
        and (bool(one.broken), one.close) <= (bool(chosen.broken), chosen.close)
        and all(abs(one.ratios[n] - chosen.ratios[n]) <= a for n, a in alike.items())
        for one in result.tried
    )


def gains_to_copy(result: GainsResult) -> tuple[float, float]:
    """Return the chosen kp [1] and kd [s]; 0 for one that buys nothing or is less than the search resolves.

    Where nothing changes anything, as for a law that does not use its gains, they stay as they are.
    """
    if len({round(one.cost, 9) for one in result.tried}) == 1:
        return result.kp, result.kd
    if buys_nothing(result):
        return 0.0, 0.0
    made: Any = design(result.name, result.loop.device, result.loop.timing)
    least, tick = RESOLVED**2 * result.limits.noise_gain, result.loop.timing.dt
    kp, kd = (
        max(pair) if noise_gain(*pair, made.filter, tick) > least else 0.0
        for pair in ((result.kp, 0.0), (0.0, result.kd))
    )
    return kp, kd


@plain_function
def fit_gains(
    loop: LoopModel,
    law: str = "tca-damped",
    *,
    limits: Limits | None = None,
    vary: float = 0.3,
    evaluations: int = 75,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> GainsResult:
    """Choose K_p and K_d of eq. (2) for the loop of a log.

    Every pair is simulated on presses, to two depths, of the identified hand, of the ends of its interval, and of hands
    `vary` away from it. Settling time, swing and noise are divided by those of the default gains; the cost falls with
    all three, and an improvement of one at the expense of another is not rewarded. The constraints apply to the worst
    press, with a margin of a tenth of overshoot and energy for other hands. The search begins with points over the
    whole range, then runs NLopt's COBYLA from the default and from the best of them; the result is the best point that
    satisfies all constraints. The default is one of the points: where it satisfies them, the result is never worse on
    these presses.

    Parameters
    ----------
    loop : LoopModel
        The loop, from `fit_loop`.
    law : str
        A law with the force loop of eq. (2): `tca`, `tca-damped`. On the observer, which it has here, `ebac` does not
        use its gains.
    limits : Limits, optional
        Constraints.
    vary : float
        Relative distance of the further hands from the identified one, [0, 3].
    evaluations : int
        Largest number of pairs that COBYLA tries, at least 1.
    threads : int, optional
        Threads of the simulation, [1, 1024]; default: one per usable core.
    progress : callable, optional
        Called with the number of pairs that are done and the largest number of pairs.

    Returns
    -------
    GainsResult

    Raises
    ------
    ValueError
        When the log does not determine the hand, the law has no force loop, the device has no force sensor, its axes
        are not straight, a number is out of range, or no pair keeps the constraints; the message names them.
    """
    require(
        loop,
        LoopModel,
        "ebac.identify.fit_gains",
        "a LoopModel, as ebac.identify.fit_loop returns it",
    )
    known = force_loop_laws()
    if law not in known:
        raise ValueError(
            f"law {law!r}: has no force loop of eq. (2); those that have: {', '.join(known)}"
        )
    if not 0 <= vary <= 3:
        raise ValueError(f"vary = {nearest_float(vary):g}: must lie in [0, 3]")
    if not 1 <= evaluations <= MOST_EVALUATIONS:
        raise ValueError(f"evaluations = {evaluations}: must lie in [1, {MOST_EVALUATIONS}]")
    device = loop.device
    if not device.sensor.fitted:
        raise ValueError(f"device.sensor.fitted = False: {NO_SENSOR}")
    if not isinstance(device.kinematics, Linear):
        raise ValueError(
            f"device = a {type(device.kinematics).__name__}: presses are simulated on a straight axis; give fit_loop "
            f"device.replace(kinematics=ebac.Linear(radius={device.radius:g}))"
        )
    hands = arms_around(loop.arm, vary)
    scenarios = tuple(
        loop.pressing(hand, depth=depth, seed=1 + i * len(DEPTHS) + j)
        for i, hand in enumerate(hands)
        for j, depth in enumerate(DEPTHS)
    )
    search = GainsSearch(law, scenarios, loop, limits or Limits(), threads, progress, evaluations)
    default, turned_down, rules, chosen = search.run()
    return GainsResult(
        loop=loop,
        name=law,
        hands=tuple(hands),
        limits=search.limits,
        chosen=chosen,
        default=default,
        turned_down=turned_down,
        rules=rules,
        tried=tuple(search.tried),
    )
