"""Run a scenario under a law."""

from __future__ import annotations

import copyreg
from collections.abc import Sequence
from typing import Any

import numpy as np

from ebac import _core
from ebac._util import remarks
from ebac._util.arguments import number, require
from ebac._util.at_user import warn
from ebac._util.doubts.scenario import doubts as doubts_before
from ebac._util.fault_of_drives import of_drives
from ebac._util.fault_remedies import REMEDIES
from ebac._util.foreign_worlds import foreign
from ebac._util.kept_law import KeptLaw, law_error
from ebac._util.raised import raised
from ebac.laws import AnyLaw, CoreLaw, PythonLaw, design, law_name
from ebac.laws.protocols import is_core_law
from ebac.laws.tuned_laws import on_its_observer
from ebac.laws.variant import law_text
from ebac.scenario import Scenario
from ebac.trace import Trace

__all__ = [
    "DoubtWarning",
    "LoopFault",
    "simulate",
]


def __dir__() -> list[str]:
    return __all__


class DoubtWarning(UserWarning):
    """A number is possible, but more likely not meant. See `Scenario.doubts`, `Trace.doubts`.

    To turn all of them off: `warnings.simplefilter("ignore", ebac.DoubtWarning)`.
    """


class LoopFault(RuntimeError):
    """The loop stopped on a fault. Its force was zero from that tick on.

    Attributes
    ----------
    fault : Fault
        The first fault; it latched.
    trace : Trace
        Every row up to the stop; the last ones are the evidence.
    remedy : str
        What to do first; empty where a law, hand or world of your own raised an error.

    Where a law, hand or world of your own raised an error, that is its `__cause__`.
    """

    def __init__(
        self,
        fault: _core.Fault,
        trace: Trace,
        hand: BaseException | None = None,
        world: BaseException | None = None,
        limits: _core.Limits | None = None,
        law: BaseException | None = None,
        nodes: Sequence[int] = (),
    ) -> None:
        self.fault = fault
        self.trace = trace
        self.remedy = REMEDIES[fault] if (hand or world or law) is None else ""
        row = int((trace["fault"] != 0).argmax())
        cause = fault.name.lower().replace("_", " ")
        if hand is not None:
            model = type(trace.scenario.hand.model).__name__ if trace.scenario else "the hand"
            cause = f"the hand {model} raised {raised(hand)}"
        elif world is not None:
            what = getattr(trace.scenario and trace.scenario.environment, "what", "the world")
            cause = f"{what} raised {raised(world)}"
        elif law is not None:
            cause = f"the law {trace.law} raised {raised(law)}"
        elif fault is _core.Fault.LAW_NOT_FINITE:
            cause = f"{cause}: {trace.law or 'the law'} gave no finite force"
        elif limits is not None:
            cause += _beyond(fault, trace, row, limits)
        super().__init__(
            f"fault {int(fault)} ({cause}){of_drives(fault, trace, row, nodes)} in tick {trace['tick'][row]}, t = "
            f"{trace['t'][row]:.6g} s: "
            "the command was set to zero and the loop stopped; see .trace for the rows before it"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what a copy is made from: its text, not the arguments."""
        return copyreg.__newobj__, (type(self), *self.args), self.__dict__  # type: ignore[attr-defined]


def _beyond(fault: _core.Fault, trace: Trace, row: int, limits: _core.Limits) -> str:
    """Return which axis was beyond which limit, as far as the row of the fault shows it."""
    column, limit, scale, unit, name = {
        _core.Fault.OVERSPEED: ("v", limits.speed, 1.0, "m/s", "Limits.speed"),
        _core.Fault.WORKSPACE: ("x", limits.end, 1e3, "mm", "Limits.end"),
    }.get(fault, ("x", np.inf, 1.0, "", ""))
    values = np.atleast_1d(trace[column][row])
    axis = int(np.abs(values).argmax())
    if not abs(values[axis]) > limit:
        return ""
    return f": axis {axis} at {scale * values[axis]:.4g} {unit}, beyond {name} = {scale * limit:.4g} {unit}"


def simulate(
    scenario: Scenario,
    law: AnyLaw = "ebac",
    *,
    through: str | None = None,
    bus: _core.TimedBus | None = None,
    limits: _core.Limits | bool = False,
    soft_start: float = 0.0,
    ramp_down: float = 0.0,
    **changes: Any,
) -> Trace:
    """Run a scenario under a law to its end.

    Parameters
    ----------
    scenario : Scenario
        Device, hand, virtual world and time.
    law : str, law class, law or PythonLaw
        A name or class is designed for the scenario's device and timing, jitter included; a law is used as it is.
    through : "can" or None
        None puts the plant at the loop's side. "can" puts a CAN bus in between: simulated CANopen drives (CiA 402),
        one per axis, enabled before the first tick and disabled after the last; torque then goes in whole
        thousandths of the rated torque, and the trace has columns `bus.*`. All others are the same, to the bit,
        as those of a run without a bus whose drive has `permille=True`, as long as no drive limits its current by i2t:
        at its peak current it does so after more than a minute, and `bus.actual_permille` is then less than asked.
    bus : TimedBus, optional
        With `through="can"`: a bus that takes time. Each frame arrives when its last bit has passed, with its own stuff
        bits, behind frames of a higher priority; drives answer after a time of their own, and frames may be destroyed.
        Answers that the loop did not wait for are missing in their tick (`bus.missing`, `bus.late`). Drives and loop
        watch each other, as on hardware. Default: every frame arrives at once.
    limits : Limits or bool
        False runs without limits, True with those of the device (`Limits.of(device)`): current, i2t, slew, edge of
        the workspace; and what else must end a run is then a fault. The trace has columns `limit.*`.
    soft_start : float
        Time in which the force comes in at the start [s], 0 to 60.
    ramp_down : float
        Time in which it goes out after `seconds` [s], 0 to 10, as at the end of a run on hardware: a hand that still
        presses falls through the wall. The rows of that time have the state STOP. With 0 the last row is under the law.
    **changes
        Parameters to set on top of the design, in their SI units.

    Returns
    -------
    Trace
        One row per tick, `seconds / dt + 1` rows under the law; with `ramp_down` also those of the ramp, and 10 of
        zero force.

    Warns
    -----
    UserWarning
        When the process data would take over 70 % of the bus: 1 Mbit/s, or that of `bus`; when an engine's models
        were so old that their force faded.
    DoubtWarning
        For what `scenario.doubts()` lists before the run, and `trace.doubts()` after it.

    Raises
    ------
    LoopFault
        When a stage gave no finite number, a law, hand or world in Python raised an error, or the device left its
        limits; carries the trace.
    MemoryError
        When the rows do not fit into memory.
    KeyError, TypeError, ValueError
        For a law that does not exist or cannot be made; see `design`. Through CAN also for a delay of 0 samples,
        and when the process data would take over 90 % of the bus, or more time than the loop waits.
    """
    __tracebackhide__ = hidden_by_pytest
    require(scenario, Scenario, "ebac.simulate", "a Scenario")
    require(limits, (_core.Limits, bool), "ebac.simulate", "limits=True, False or a Limits")
    for name in changes:
        if name in Scenario.__dataclass_fields__ and name != "observer":  # which laws have, too
            raise TypeError(
                f"{name} belongs to the scenario, not to a law: ebac.simulate(scenario.replace({name}=...), law)"
            )
    soft_start = number("simulate.soft_start", soft_start)
    ramp_down = number("simulate.ramp_down", ramp_down)
    if bus is not None:
        require(bus, _core.TimedBus, "ebac.simulate", "a TimedBus")
        if through is None:
            raise ValueError("bus = a TimedBus without a bus to time: give through='can' as well")
    scenario = on_its_observer(scenario, law)
    if through is not None:
        scenario = on_bus(scenario, through, bus)
    finished = design(law, scenario.device, scenario.known_timing, **changes)
    world = foreign(scenario.environment)
    mine = None if world is None else world.for_run()
    setup = (scenario if mine is None else scenario.replace(environment=mine)).setup()
    allowed = limits if isinstance(limits, _core.Limits) else None
    if limits is not False or soft_start != 0 or ramp_down != 0:
        if limits is True:
            allowed = _core.Limits.of(scenario.device)
        setup = _core._with_loop(setup, soft_start=soft_start, ramp_down=ramp_down, limits=allowed)
    _check_observer(finished, scenario)
    by_user = remarks.wanted()
    if by_user:
        warn_of(doubts_before(scenario, quick=True))
    errors: list[BaseException] = []
    try:
        if is_core_law(finished):
            rows = finished._simulate(setup, through is not None, bus)
        else:
            kept = KeptLaw(finished, errors)
            rows = _core._simulate_python(setup, kept, through is not None, bus)
    except MemoryError:
        raise MemoryError(_too_long(scenario)) from None
    name = law if isinstance(law, str) else law_name(finished)
    trace = Trace.from_rows(rows, scenario=scenario, law=name, law_repr=law_text(finished))
    fault = _core.Fault(int(trace["fault"][-1]))
    own = None if mine is None else mine.error
    if own is not None and not isinstance(own, Exception):
        raise own
    of_law = law_error(errors)
    if fault is not _core.Fault.NONE:
        error = _hand_error(setup)
        raise LoopFault(fault, trace, error, own, allowed, of_law) from error or own or of_law
    if mine is not None and (remark := mine.remark()):
        warn(remark)
    if by_user:
        warn_of(trace.doubts())
    return trace


def hidden_by_pytest(failure: Any) -> bool:
    """Return whether a failed test shows the line that called `simulate` alone: for faults and wrong arguments."""
    return isinstance(failure.value, (LoopFault, KeyError, TypeError, ValueError))


def warn_of(doubts: tuple[str, ...]) -> None:
    """Warn of each at the line outside the package that led here."""
    for text in doubts:
        warn(text, DoubtWarning)


def _too_long(scenario: Scenario) -> str:
    seconds, dt = scenario.seconds, scenario.timing.dt
    return (
        f"{round(seconds / dt) + 1:,} rows, of {seconds:g} s in ticks of {dt:g} s, do not fit into memory: simulate "
        "less time at once, or longer ticks"
    )


def _check_observer(law: CoreLaw | PythonLaw, scenario: Scenario) -> None:
    """Refuse a law in Python that goes by an estimate which nothing makes."""
    if is_core_law(law) or scenario.observer or not getattr(law, "observer", False):
        return
    name = law_name(law)
    raise ValueError(
        f"the law {name} has observer = True: it goes by the estimate of the state observer, which "
        "Scenario(observer=False) turns off; leave observer=False out, or set the law's observer to False"
    )


def _hand_error(setup: _core.Setup) -> Exception | None:
    """Return what a hand of the user's own raised; an interrupt is raised again."""
    try:
        setup._raise_hand_error()
    except Exception as error:
        return error
    return None


def on_bus(scenario: Scenario, through: str, bus: _core.TimedBus | None = None) -> Scenario:
    """Return the scenario as drives on a bus can run it: torque in whole thousandths.

    Raises
    ------
    ValueError
        When there is no such bus, or it cannot carry the frames of loop and drives.
    """
    if through != "can":
        raise ValueError(f"through = {through!r}: must be 'can' or None")
    warning = _core._load_on_bus(scenario.device.axes, scenario.timing.dt, bus).check()
    if warning:
        warn(warning)
    drive = scenario.device.drive.replace(permille=True)
    return scenario.replace(device=scenario.device.replace(drive=drive))
