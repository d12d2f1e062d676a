"""One drive: its state machine, its mode, its faults."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import TracebackType
from typing import Self

from ebac._util.arguments import whole
from ebac._util.exception_notes import noted_on
from ebac._util.wrong_calls import plain_constructor
from ebac.drives import faults
from ebac.drives.bus_node import BusNode
from ebac.drives.errors import DriveFault, WrongAnswer, WrongState
from ebac.drives.state import AUTOMATIC, Command, State, Statusword, path

#: Modes of operation this package uses (CiA 402-2, object 0x6060).
MODES = {4: "profile torque", 10: "cyclic synchronous torque"}
#: How often a state is asked for while waiting [s], and how long a change may take [s].
_POLL, _DEADLINE = 0.002, 2.0


@plain_constructor
class Drive(BusNode):
    """A CiA 402 drive on a bus. As a context manager it is disabled on exit, whatever happened.

    Get it from `DriveBus.drive`; the parameters are those of `BusNode`.
    """

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        with noted_on(error, "and the drive could not be disabled"):
            self.disable()

    @property
    def statusword(self) -> Statusword:
        """The statusword, asked for now."""
        return Statusword(self.number("statusword"))

    @property
    def state(self) -> State:
        """The state, asked for now. Raises WrongAnswer for a statusword of no state."""
        try:
            return State.of(self.statusword)
        except ValueError as error:
            raise WrongAnswer(f"node {self.node}: {error}", node=self.node) from None

    def command(self, command: Command) -> None:
        """Write the controlword of a command. What follows is for `wait` to see."""
        self.write("controlword", command.value)

    def wait(self, wanted: Callable[[State], bool], what: str, *, timeout: float) -> State:
        """Wait for a state.

        Parameters
        ----------
        wanted : callable
            Whether a state is one to stop at.
        what : str
            What is waited for, for the message.
        timeout : float
            How long [s].

        Raises
        ------
        WrongState
            When it has not come in time.
        """
        deadline = time.monotonic() + timeout
        while not wanted(state := self.state):
            if time.monotonic() > deadline:
                raise WrongState(self.node, what, state, self._hint())
            time.sleep(_POLL)
        return state

    def go(self, goal: State, *, timeout: float = _DEADLINE) -> None:
        """Lead the drive to a state, one command after the other, each one seen to act.

        Raises
        ------
        DriveFault
            When the drive is or falls in fault.
        WrongState
            When a step does not come within `timeout` [s].
        ValueError
            When no command leads there.
        """
        deadline = time.monotonic() + timeout
        while (state := self.state) is not goal:
            left = max(0.0, deadline - time.monotonic())
            if state in AUTOMATIC and goal is not AUTOMATIC[state]:
                self.wait(lambda now: now not in AUTOMATIC, goal.value, timeout=left)
            elif state is State.FAULT and goal is not State.FAULT:
                raise self.fault(f"going to {goal.value!r}")
            elif left == 0:
                raise WrongState(self.node, repr(goal.value), state, self._hint())
            else:
                self._step(state, goal, left)

    def _step(self, state: State, goal: State, left: float) -> None:
        try:
            commands = path(state, goal)
        except ValueError as error:
            raise ValueError(f"node {self.node}: {error}") from None
        if commands:
            self.command(commands[0])
        self.wait(lambda now: now is not state, repr(goal.value), timeout=left)

    def enable(self, *, mode: int | None = None, timeout: float = _DEADLINE) -> None:
        """Power the motor at zero torque, in a mode that commands torque.

        Parameters
        ----------
        mode : int, optional
            Mode of operation to set first: 4 profile torque, 10 cyclic synchronous torque.
        timeout : float
            How long it may take [s].

        Raises
        ------
        DriveFault, WrongState, WrongAnswer
            When it does not come to that; the drive is then disabled.
        """
        if mode is not None:
            self.set_mode(mode)
        elif (acting := self.number("mode_display")) not in MODES:
            raise WrongAnswer(
                f"node {self.node}: mode {acting} acts, which does not command torque, so zero torque "
                "cannot be promised: apply a profile first, or give a mode: 10 cyclic synchronous "
                "torque, 4 profile torque",
                node=self.node,
            )
        self.zero_torque()
        self.bus.check_alone([self.node])
        try:
            self.go(State.OPERATION_ENABLED, timeout=timeout)
        except BaseException as error:
            with noted_on(error, "and the drive could not be disabled"):
                self.disable()
            raise

    def zero_torque(self) -> None:
        """Write zero to the target torque and to its offset, and read both back.

        Raises
        ------
        WrongAnswer
            When one of them does not stay zero.
        """
        for name in ("target_torque", "torque_offset"):
            if name == "torque_offset" and not self.look(name):
                continue  # none, or 0
            self.write(name, 0)
            if self.number(name) != 0:
                raise WrongAnswer(
                    f"node {self.node}: {name} does not stay 0: another program or master commands it; end that one",
                    node=self.node,
                )

    def disable(self, *, timeout: float = _DEADLINE) -> State:
        """Take the power off the motor, from any state; return the state it rests in.

        The node goes to NMT pre-operational first, so that no PDO of a running loop enables it again.

        Raises
        ------
        WrongState
            When the drive does not obey; then cut its power.
        """
        self.nmt("pre-operational")
        resting = (State.SWITCH_ON_DISABLED, State.FAULT)
        if (state := self.state) in resting:
            return state
        self.command(Command.DISABLE_VOLTAGE)
        return self.wait(lambda now: now in resting, "disabled", timeout=timeout)

    def quick_stop(self, *, timeout: float = _DEADLINE) -> State:
        """Brake as 0x605A configures it; return the state it ends in, at last "switch on disabled".

        Raises
        ------
        WrongState
            When the drive does not obey; then cut its power.
        """
        self.command(Command.QUICK_STOP)
        return self.wait(
            lambda now: now is not State.OPERATION_ENABLED, "a quick stop", timeout=timeout
        )

    def reset_fault(self, *, timeout: float = _DEADLINE) -> None:
        """Reset a fault by the rising edge of bit 7, and see that it is gone. No fault: no change.

        Raises
        ------
        DriveFault
            When the fault stays, as its cause does.
        """
        state = self.state
        if state is State.FAULT_REACTION_ACTIVE:
            state = self.wait(
                lambda now: now is not State.FAULT_REACTION_ACTIVE, "in fault", timeout=timeout
            )
        if state is not State.FAULT:
            return
        self.command(Command.DISABLE_VOLTAGE)  # bit 7 low first: only its rising edge acts
        self.command(Command.FAULT_RESET)
        deadline = time.monotonic() + timeout
        while self.state is State.FAULT and time.monotonic() < deadline:
            time.sleep(_POLL)
        self.command(Command.DISABLE_VOLTAGE)  # bit 7 low again, for the next time
        if self.state in (State.FAULT, State.FAULT_REACTION_ACTIVE):
            raise self.fault("resetting the fault")
        remembered = self.look("latched_faults")
        if isinstance(remembered, int) and remembered:
            self.write("latched_faults", remembered)  # a 1 written clears the bit (Copley)

    def set_mode(self, mode: int, *, timeout: float = _DEADLINE) -> None:
        """Set the mode of operation and see it act (0x6060, 0x6061).

        Raises
        ------
        TypeError
            For a mode that is no whole number.
        ValueError
            For a mode the drive does not offer (0x6502).
        WrongAnswer
            When it does not act within `timeout` [s].
        """
        mode = whole("mode", mode)
        offered = self.look("supported_modes")
        if not 1 <= mode <= 32 or (isinstance(offered, int) and not offered >> (mode - 1) & 1):
            modes = [n for n in range(1, 33) if isinstance(offered, int) and offered >> (n - 1) & 1]
            raise ValueError(f"node {self.node}: mode = {mode}: the drive offers {modes}")
        self.write("mode", mode)
        deadline = time.monotonic() + timeout
        while (acting := self.number("mode_display")) != mode:
            if time.monotonic() > deadline:
                raise WrongAnswer(
                    f"node {self.node}: mode {mode} was asked, mode {acting} acts: "
                    "disable the drive first, and see its manual for when it changes mode",
                    node=self.node,
                )
            time.sleep(_POLL)

    def latched(self) -> list[str]:
        """Return the names of the latched faults; none where the drive has no such object."""
        word = self.look("latched_faults")
        return faults.latched(word) if isinstance(word, int) else []

    def fault(self, doing: str) -> DriveFault:
        """Return the fault the drive is in, with all its details, as an exception to raise."""
        code = self.look("error_code")
        return DriveFault(
            self.node,
            code=code if isinstance(code, int) else None,
            emergencies=[str(one) for one in self.bus.monitor.emergencies(self.node)],
            latched=self.latched(),
            doing=doing,
        )

    def _hint(self) -> str:
        """Say why a drive may not obey."""
        if not self.statusword & Statusword.REMOTE:
            return (
                "its statusword shows no remote control (bit 9): Copley drives obey CANopen "
                "only when desired_state (0x2300) is 30"
            )
        return "is its enable input active, is its supply on, does another program command it?"
