"""The state machine of CiA 402 in one table: states, commands, and the way between any two.

Sources: CiA 402-2, clause "state machine"; statusword 0x6041, controlword 0x6040.
"""

from __future__ import annotations

from collections import deque
from enum import Enum, IntFlag
from types import MappingProxyType
from typing import Self


class Statusword(IntFlag):
    """Bits of the statusword, 0x6041 (CiA 402-2)."""

    READY_TO_SWITCH_ON = 1 << 0
    SWITCHED_ON = 1 << 1
    OPERATION_ENABLED = 1 << 2
    FAULT = 1 << 3
    VOLTAGE_ENABLED = 1 << 4
    NOT_QUICK_STOP = 1 << 5  # 0 while a quick stop acts
    SWITCH_ON_DISABLED = 1 << 6
    WARNING = 1 << 7
    MANUFACTURER_8 = 1 << 8
    REMOTE = 1 << 9  # 0: the controlword is not obeyed
    TARGET_REACHED = 1 << 10
    INTERNAL_LIMIT = 1 << 11
    MODE_12 = 1 << 12  # meaning by mode of operation
    MODE_13 = 1 << 13
    MANUFACTURER_14 = 1 << 14
    MANUFACTURER_15 = 1 << 15


class Controlword(IntFlag):
    """Bits of the controlword, 0x6040 (CiA 402-2)."""

    SWITCH_ON = 1 << 0
    ENABLE_VOLTAGE = 1 << 1
    NOT_QUICK_STOP = 1 << 2  # 0 asks for a quick stop
    ENABLE_OPERATION = 1 << 3
    MODE_4 = 1 << 4
    MODE_5 = 1 << 5
    MODE_6 = 1 << 6
    FAULT_RESET = 1 << 7  # acts on its rising edge
    HALT = 1 << 8


class State(Enum):
    """A state of the drive. The value is what people read."""

    NOT_READY_TO_SWITCH_ON = "not ready to switch on"
    SWITCH_ON_DISABLED = "switch on disabled"
    READY_TO_SWITCH_ON = "ready to switch on"
    SWITCHED_ON = "switched on"
    OPERATION_ENABLED = "operation enabled"
    QUICK_STOP_ACTIVE = "quick stop active"
    FAULT_REACTION_ACTIVE = "fault reaction active"
    FAULT = "fault"

    @classmethod
    def of(cls, statusword: int) -> Self:
        """Return the state in a statusword.

        Parameters
        ----------
        statusword : int
            Value of 0x6041, 0 to 0xFFFF.

        Raises
        ------
        ValueError
            When its bits 0 to 3, 5 and 6 fit no state.
        """
        for mask, bits, state in STATUS:
            if statusword & mask == bits:
                return cls(state)
        raise ValueError(
            f"statusword = 0x{statusword:04X}: bits 0 to 3, 5, 6 are no state of CiA 402; "
            "is 0x6041 of this drive a CiA 402 statusword?"
        )

    @property
    def powered(self) -> bool:
        """Whether the motor may carry current."""
        return self in POWERED


#: Mask, value, state: how a statusword is read (CiA 402-2, state coding).
STATUS: tuple[tuple[int, int, str], ...] = (
    (0x4F, 0x00, "not ready to switch on"),
    (0x4F, 0x40, "switch on disabled"),
    (0x6F, 0x21, "ready to switch on"),
    (0x6F, 0x23, "switched on"),
    (0x6F, 0x27, "operation enabled"),
    (0x6F, 0x07, "quick stop active"),
    (0x4F, 0x0F, "fault reaction active"),
    (0x4F, 0x08, "fault"),
)


class Command(Enum):
    """A command of CiA 402 with its controlword. "Disable operation" is the word of `SWITCH_ON`."""

    DISABLE_VOLTAGE = 0x00
    QUICK_STOP = 0x02
    SHUTDOWN = 0x06
    SWITCH_ON = 0x07
    DISABLE_OPERATION = 0x07  # noqa: PIE796 - CiA 402 gives one word two names
    ENABLE_OPERATION = 0x0F
    FAULT_RESET = 0x80

    @property
    def word(self) -> Controlword:
        """Its controlword."""
        return Controlword(self.value)


#: States in which the motor may carry current.
POWERED = frozenset({State.OPERATION_ENABLED, State.QUICK_STOP_ACTIVE, State.FAULT_REACTION_ACTIVE})

#: State, command, state after it (transition of CiA 402-2). What is not here changes nothing.
TRANSITIONS = MappingProxyType(
    {
        (State.SWITCH_ON_DISABLED, Command.SHUTDOWN): State.READY_TO_SWITCH_ON,  # 2
        (State.READY_TO_SWITCH_ON, Command.SWITCH_ON): State.SWITCHED_ON,  # 3
        (State.READY_TO_SWITCH_ON, Command.ENABLE_OPERATION): State.OPERATION_ENABLED,  # 3 and 4
        (State.READY_TO_SWITCH_ON, Command.DISABLE_VOLTAGE): State.SWITCH_ON_DISABLED,  # 7
        (State.READY_TO_SWITCH_ON, Command.QUICK_STOP): State.SWITCH_ON_DISABLED,  # 7
        (State.SWITCHED_ON, Command.ENABLE_OPERATION): State.OPERATION_ENABLED,  # 4
        (State.SWITCHED_ON, Command.SHUTDOWN): State.READY_TO_SWITCH_ON,  # 6
        (State.SWITCHED_ON, Command.DISABLE_VOLTAGE): State.SWITCH_ON_DISABLED,  # 10
        (State.SWITCHED_ON, Command.QUICK_STOP): State.SWITCH_ON_DISABLED,  # 10
        (State.OPERATION_ENABLED, Command.DISABLE_OPERATION): State.SWITCHED_ON,  # 5
        (State.OPERATION_ENABLED, Command.SHUTDOWN): State.READY_TO_SWITCH_ON,  # 8
        (State.OPERATION_ENABLED, Command.DISABLE_VOLTAGE): State.SWITCH_ON_DISABLED,  # 9
        (State.OPERATION_ENABLED, Command.QUICK_STOP): State.QUICK_STOP_ACTIVE,  # 11
        (State.QUICK_STOP_ACTIVE, Command.DISABLE_VOLTAGE): State.SWITCH_ON_DISABLED,  # 12
        (State.QUICK_STOP_ACTIVE, Command.ENABLE_OPERATION): State.OPERATION_ENABLED,  # 16
        (State.FAULT, Command.FAULT_RESET): State.SWITCH_ON_DISABLED,  # 15
    }
)

#: What the drive does by itself: 1, 14. (0 and 13, power-on and a fault, come from anywhere.)
AUTOMATIC = MappingProxyType(
    {
        State.NOT_READY_TO_SWITCH_ON: State.SWITCH_ON_DISABLED,
        State.FAULT_REACTION_ACTIVE: State.FAULT,
    }
)

#: Older drives do not take both steps at once, and not every one leaves a quick stop to go on.
_NOT_EVERYWHERE = frozenset(
    {
        (State.READY_TO_SWITCH_ON, Command.ENABLE_OPERATION),
        (State.QUICK_STOP_ACTIVE, Command.ENABLE_OPERATION),
    }
)


def after(state: State, command: Command) -> State:
    """Return the state that follows `command` in `state`; the same where it means nothing."""
    return TRANSITIONS.get((state, command), state)


def path(start: State, goal: State) -> tuple[Command, ...]:
    """Return the shortest commands from one state to another, by transitions every drive has.

    A state the drive leaves by itself counts as the one that follows it: wait for that first.

    Parameters
    ----------
    start, goal : State
        Where the drive is, and where it is to be.

    Returns
    -------
    tuple of Command
        In their order; empty where the drive is there.

    Raises
    ------
    ValueError
        When no command leads there: a fault and what a drive does by itself cannot be commanded.
    """
    begin = start if start is goal else AUTOMATIC.get(start, start)
    ways: dict[State, tuple[Command, ...]] = {begin: ()}
    open_ = deque([begin])
    while open_:
        state = open_.popleft()
        if state is goal:
            return ways[state]
        for (before, command), then in TRANSITIONS.items():
            if before is state and then not in ways and (before, command) not in _NOT_EVERYWHERE:
                ways[then] = (*ways[state], command)
                open_.append(then)
    raise ValueError(
        f"no command leads from {start.value!r} to {goal.value!r}: a drive gets there by itself"
    )
