"""The result of a contact with a wall: its numbers, as text and as tables."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass

from ebac._util import formatting, verdicts

#: Share of a wall's stiffness on impact below which a contact is soft.
SOFT_BELOW = 0.5
#: Numbers of a contact that are no keys of `ebac wall --json`.
MORE = (
    "count_m", "allowed_m", "most_drawn_J", "force_step_N", "most_pull_N", "rest_power_W", "seconds", "touched",
    "with_hand", "at_hands_pace", "surface_moves", "saturated_share",
)  # fmt: skip
#: What a printed contact shows: label, attribute, unit, what to print where there is none: with nothing, no line.
LINES = (
    ("rest", "rest_m", "m", "-"),
    ("ideal rest", "ideal_m", "m", "-"),
    ("deviation", "deviation_m", "m", "-"),
    ("allowed deviation", "allowed_m", "m", "-"),
    ("swing", "swing_m", "m", "-"),
    ("force at rest", "force_rest_N", "N", "-"),
    ("force swing", "force_swing_N", "N", "-"),
    ("settled", "settled_s", "s", "never"),
    ("force settled", "force_settled_s", "s", "never"),
    ("ripple", "ripple_N", "N", "-"),
    ("ripple, rms", "ripple_rms_N", "N", "-"),
    ("above 20 Hz, rms", "ripple_high_N", "N", "-"),
    ("force jumps", "jumps", "1", "-"),
    ("vibration/threshold", "perceived", "threshold", "-"),
    ("deepest", "peak_m", "m", "-"),
    ("stiffness on impact", "impact_share", "share", "-"),
    ("limit cycle", "limit_cycle", "Hz", "none"),
    ("least energy", "least_energy_J", "J", "-"),
    ("drawn", "drawn_J", "J", ""),
    ("drawn in any window", "most_drawn_J", "J", "-"),
    ("force limited", "clamped_share", "share", "-"),
    ("motor saturated", "saturated", "share", ""),
)


@dataclass(frozen=True, kw_only=True, repr=False)
class Contact:
    """A wall contact in numbers, SI units, the unit in the name; None where a thing does not exist.

    Attributes
    ----------
    law : str
        Name of the law.
    rest_m : float
        Mean position over the last 30 % of the run.
    ideal_m : float or None
        Where an ideal wall would rest; None where the scenario has no such point.
    swing_m, force_swing_N : float
        Position and applied force, peak to peak, over the last 30 %.
    settled_s : float or None
        From when on the position stays within 0.125 mm of its rest; None when it never does.
    peak_m : float
        Deepest position of the whole run.
    impact_share : float or None
        Share of the wall's stiffness that the hand meets at the deepest position of the run: the applied force there
        over that of the virtual world. 1 for an ideal wall; a law that lets the hand in and brings it back later is
        exact at rest and has less here. None where the world does not act there.
    limit_cycle_Hz : float or None
        Frequency of the swing; None when it is still or drifts without swinging back.
    least_energy_J : float or None
        Lowest physical port energy, integral of (f v + b v^2 + friction); None without a simulation.
    drawn_J : float or None
        In a world that moves, energy drawn beyond all that the hand had put in and beyond what the surfaces did, which
        the least energy counts: `ebac.metrics.drawn`. None where nothing moved.
    most_drawn_J : float or None
        Energy drawn in any window beyond what an ideal wall stores at the window's start, max over t1 < t2 of
        W(t1) - W(t2) - K depth(t1)^2 / 2; 0 for an ideal wall. None without a simulation, and in a world that is a
        function, or an engine of a function: what it stores is not known.
    clamped_share : float or None
        Share of ticks in which the law limited its force; None for a law without such a limit.
    force_step_N : float
        Largest change of the applied force from one tick to the next.
    most_pull_N : float or None
        Hardest pull of the hand, |K0 (X0 - x)|, while the virtual world acts; None without a simulation and for a hand
        of your own.
    rest_power_W : float or None
        Mean rate of the port energy over the last 30 %, dW/dt at rest; negative where the port gives out energy for
        as long as it is held. None without a simulation, and unless the run is at rest from 20 s before its last 30 %
        on: the position stays within 0.125 mm of its rest, and the force, which may click, within the range of the
        last 30 %, widened by 5 % of its rest or 0.2 N, the larger. So a run of less than 28.6 s has none.
    force_rest_N : float
        Mean applied force over the last 30 % of the run.
    force_settled_s : float or None
        From when on the applied force stays within 5 % of its rest, or 0.2 N where that is more; None where that comes
        after the last 30 % have begun.
    ripple_N, ripple_rms_N : float
        Applied force after position and force have settled, or over the last 30 % where one does not: peak to peak, and
        root mean square around its mean.
    ripple_high_N : float or None
        Root mean square of the force behind a Butterworth high-pass of second order at 20 Hz (bilinear transform), from
        twice the settling time on as `perceived`; the filter starts with the run, as after a long rest on its first
        value. None below 80 rows a second.
    jumps : int
        Changes of the applied force by more than 0.2 N from one tick to the next after the position has settled, or
        over the last 30 % where it does not.
    perceived : float or None
        Largest vibration of the applied force in detection thresholds [1], >= 0, see Notes: from twice the time
        in which the position settles, and half a second after it has settled at least; over the last 30 % where that
        is later or the position does not settle. None below 80 rows a second.
    still : bool
        Whether the position swings by less than 0.25 mm over the last 30 %.
    force_quiet : bool
        Whether the force settles and `perceived` is below 3.
    quiet : bool
        The verdict behind every table, study, map and figure: `still` and `force_quiet`.
    count_m : float or None
        One encoder count.
    allowed_m : float or None
        How far from the ideal a rest still counts as `exact`, see `allowed_deviation`.
    seconds : float or None
        Length of the run [s].
    touched : bool or None
        Whether the virtual world ever acted; None where that is not known.
    touched_at_rest : bool or None
        Whether it acted in the last half second of the run, in 1.25 swings where that is longer, or in its last 30 %
        where that is shorter: False where the handle left the surface, and rest, swing and force are those of free air.
        False as well where it rests and only grazes a surface, as behind a ball that it slid around: world and law
        press with less than 5 % of the force at the ideal rest. None where that is not known.
    with_hand : bool
        Whether it swings because the target of the simulated hand still moves over the last 30 %: there the handle
        goes no longer a way, to and fro, than the target on all axes, tremor apart, and turns round no more than twice
        as often and twice more; a hand that taps may bounce, by less than a tenth of the swing. Such a swing is no
        limit cycle.
    at_hands_pace : bool
        Whether the swing is no faster than the hand's, and its frequency that of no limit cycle: at most 1.25 times
        that of the simulated hand's target over the last 30 %. Where the target is not known, as in a recording on
        hardware, a swing of at most 3 Hz may be the hand's if the virtual world does not act in a fifth of the last
        30 % or more: a hand that taps, or moves in free air.
    surface_moves : bool
        Whether the surface of an engine moves, while it is touched in the last 30 %, by more than 0.025 mm, as the
        engine reports it: there the verdict judges neither rest nor swing, which may be those of the surface.
    saturated_share : float or None
        Share of ticks in which the command was more than the motor's peak force, which is applied then. None without a
        scenario, and on a gimbal, where a force is no torque of one motor.

    Notes
    -----
    `perceived` weighs vibration by how well a hand detects it: the force above 20 Hz (the high-pass of
    `ripple_high_N`), behind a low-pass of second order (200 Hz, damping 0.5), its square averaged over 0.2 s with
    exponential weight; of that power the amplitude of a sine, over 25 mN. A sine of 25 mN between 40 and 160 Hz comes
    to 1. Until twice the settling time the handle may ring down on the wall: that is no fault of a law, an ideal
    wall rings too.

    25 mN is made from the displacements of a held stylus that are just detected, and from the impedance of the hand
    that holds it [1]_: 8.5 um at 20 Hz, 13 dB less with each octave to 160 Hz, 0.06 um at 320 Hz; 14 N s/m below 40 Hz,
    7 dB less at 80 Hz, 23 dB less from 160 to 320 Hz. The force is assumed to move a handle of 0.25 kg, the reference
    device, in that hand. Both impedances make 37, 31, 27, 24 and 61 mN at 20, 40, 80, 160 and 320 Hz, and the filters
    keep within 2 dB of that up to 160 Hz, and within 4 dB at 320 Hz. Vibration sums up over about 0.2 s [2]_.

    It puts laws on one scale. It does not predict what a person feels on another handle: a light one moves more by the
    same force, and a hand that moves or presses detects less than one at rest in a laboratory. Below 20 Hz, where a
    hand feels force and motion, it says nothing. The values of [1]_ are as a digest of it quotes them.

    .. [1] A. Israr, S. Choi, H. Z. Tan, "Detection threshold and mechanical impedance of the hand in a pen-hold
       posture", IEEE/RSJ IROS 2006, 472-477.
    .. [2] R. T. Verrillo, "Temporal summation in vibrotactile sensitivity", J. Acoust. Soc. Am. 37, 1965, 843-846.
    """

    law: str
    rest_m: float
    ideal_m: float | None
    swing_m: float
    force_swing_N: float
    settled_s: float | None
    peak_m: float
    limit_cycle_Hz: float | None
    least_energy_J: float | None
    clamped_share: float | None
    force_rest_N: float
    force_settled_s: float | None
    ripple_N: float
    ripple_rms_N: float
    ripple_high_N: float | None
    jumps: int
    perceived: float | None
    still: bool
    force_quiet: bool
    quiet: bool
    count_m: float | None = None
    most_drawn_J: float | None = None
    force_step_N: float | None = None
    most_pull_N: float | None = None
    rest_power_W: float | None = None
    allowed_m: float | None = None
    seconds: float | None = None
    touched: bool | None = None
    touched_at_rest: bool | None = None
    drawn_J: float | None = None
    with_hand: bool = False
    at_hands_pace: bool = False
    surface_moves: bool = False
    saturated_share: float | None = None
    impact_share: float | None = None

    @property
    def verdict(self) -> str:
        """The verdict in words: "exact and quiet", "swings", "no contact", "not judged: the surface moves"."""
        return verdicts.verdict(self)

    @property
    def force_verdict(self) -> str:
        """The verdict on its force in words: "not quiet: settled 2.994 s, 338 jumps, vibration 19.8 thresholds"."""
        return verdicts.force_verdict(
            self.force_quiet, self.force_settled_s, self.jumps, self.perceived
        )

    def __repr__(self) -> str:
        """Return the verdict and the main numbers in one line."""
        settled = formatting.quantity(self.settled_s, "s", none="never")
        rest = formatting.quantity(formatting.of_contact(self, "rest_m"), "m")
        return (
            f"<Contact of {self.law or 'a run'}: {self.verdict}; rest {rest}, "
            f"swing {formatting.quantity(self.swing_m, 'm')}, settled {settled}; "
            f"force {self.force_verdict}>"
        )

    def __str__(self) -> str:
        """Return the verdict and every number with its unit, one a line."""
        lines = [f"  {label:<20}{shown}" for label, shown in self._numbers()]
        return "\n".join([self._title(), f"  force {self.force_verdict}", *lines])

    def _repr_html_(self) -> str:
        """Return the same for a notebook."""
        from ebac._util import notebook

        rows = [{"quantity": label, "value": shown} for label, shown in self._numbers()]
        return notebook.result(f"{self._title()}; force {self.force_verdict}", rows)

    def _title(self) -> str:
        return f"Contact of {self.law or 'a run'}: {self.verdict}"

    def _numbers(self) -> Iterator[tuple[str, str]]:
        """Yield the label and the text of every number that there is."""
        signed = {"deviation_m"}
        for label, name, unit, none in LINES:
            value = formatting.of_contact(self, name)
            if value is not None or none:
                yield label, formatting.quantity(value, unit, signed=name in signed, none=none)

    @property
    def deviation_m(self) -> float | None:
        """Rest minus ideal [m]; positive is too deep."""
        return None if self.ideal_m is None else self.rest_m - self.ideal_m

    @property
    def limit_cycle(self) -> float | None:
        """Frequency of a limit cycle [Hz]: that of the swing, None where the hand moves the handle as often."""
        return None if self.with_hand or self.at_hands_pace else self.limit_cycle_Hz

    @property
    def saturated(self) -> float | None:
        """`saturated_share`, None where the motor could give every command."""
        return self.saturated_share or None

    @property
    def soft(self) -> bool:
        """Whether the hand meets less than half of the wall's stiffness on impact, see `impact_share`."""
        return self.impact_share is not None and self.impact_share < SOFT_BELOW

    @property
    def exact(self) -> bool | None:
        """Whether it rests within two counts of the ideal, and what friction holds."""
        if self.deviation_m is None or self.allowed_m is None:
            return None
        return abs(self.deviation_m) <= self.allowed_m

    def row(self) -> dict[str, str | float | None]:
        """Return the documented row of `ebac wall --json`."""
        row = {name: value for name, value in asdict(self).items() if name not in MORE}
        return row | {
            "deviation_m": self.deviation_m, "exact": self.exact, "verdict": self.verdict
        }  # fmt: skip
