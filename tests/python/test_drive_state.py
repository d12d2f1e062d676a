"""CiA 402 in a table: statusword to state, commands to states, and the way between any two."""

from collections import deque

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ebac import _core
from ebac.drives.state import AUTOMATIC, TRANSITIONS, Command, State, Statusword, after, path

states = st.sampled_from(State)
commands = st.sampled_from(Command)
#: Not ready, switch on disabled, ready, switched on, enabled, quick stop, fault reaction, fault (CiA 402-2).
WORDS = (0x00, 0x40, 0x21, 0x23, 0x27, 0x07, 0x0F, 0x08)
#: No command leads into these.
BY_THEMSELVES = (State.NOT_READY_TO_SWITCH_ON, State.FAULT_REACTION_ACTIVE, State.FAULT)


@pytest.mark.parametrize(("word", "state"), list(zip(WORDS, State, strict=True)))
@given(others=st.integers(0, 0xFFFF))
def test_only_the_bits_of_the_state_count(word: int, state: State, others: int) -> None:
    free = 0xFF90 | (0x20 if state.name.startswith(("NOT", "SWITCH_ON_", "FAULT")) else 0)
    assert State.of(word | others & free) is state


@given(word=st.integers(0, 0xFFFF))
def test_every_statusword_has_one_state_or_is_refused(word: int) -> None:
    fitting = [s for w, s in zip(WORDS, State, strict=True) if word & 0x6F in (w, w | 0x20)]
    try:
        assert State.of(word) in fitting
    except ValueError as error:
        assert f"0x{word:04X}" in str(error)  # noqa: PT017
        assert word & 0x4F in (*range(1, 8), *range(9, 15), *range(0x41, 0x50))


def test_a_statusword_without_a_state_is_refused() -> None:
    with pytest.raises(ValueError, match="statusword = 0x0002"):
        State.of(0x0002)


@given(state=states, command=commands)
def test_the_motor_is_powered_only_by_enable_operation(state: State, command: Command) -> None:
    then = after(state, command)
    if then is State.OPERATION_ENABLED and state is not State.OPERATION_ENABLED:
        assert command is Command.ENABLE_OPERATION
    if command in (Command.DISABLE_VOLTAGE, Command.SHUTDOWN) and state in {
        s for s, c in TRANSITIONS if c is command
    }:
        assert not then.powered


@pytest.mark.parametrize("state", [s for s in State if s not in AUTOMATIC and s is not State.FAULT])
def test_disable_voltage_takes_the_power_off_from_everywhere(state: State) -> None:
    assert after(state, Command.DISABLE_VOLTAGE) is State.SWITCH_ON_DISABLED


def test_a_fault_leaves_by_reset_only() -> None:
    assert [c for c in Command if after(State.FAULT, c) is not State.FAULT] == [Command.FAULT_RESET]
    assert all(
        after(State.FAULT_REACTION_ACTIVE, c) is State.FAULT_REACTION_ACTIVE for c in Command
    )


def shortest(start: State, goal: State) -> int | None:
    far = {start: 0}
    left = deque([start])
    while left:
        state = left.popleft()
        for command in Command:
            then = after(state, command)
            if then not in far:
                far[then] = far[state] + 1
                left.append(then)
    return far.get(goal)


@given(start=states, goal=states)
def test_a_path_leads_there_or_there_is_none(start: State, goal: State) -> None:
    begin = start if start is goal else AUTOMATIC.get(start, start)
    if goal in BY_THEMSELVES and begin is not goal:
        with pytest.raises(ValueError, match=goal.value):
            path(start, goal)
        return
    state, way = begin, path(start, goal)
    for command in way:
        assert after(state, command) is not state
        state = after(state, command)
    assert state is goal
    least = shortest(begin, goal)
    assert least is not None
    assert least <= len(way) <= least + 3  # no step that some drives lack


def test_the_way_to_power_is_the_one_every_drive_has() -> None:
    way = (Command.SHUTDOWN, Command.SWITCH_ON, Command.ENABLE_OPERATION)
    assert path(State.SWITCH_ON_DISABLED, State.OPERATION_ENABLED) == way
    assert path(State.FAULT, State.OPERATION_ENABLED) == (Command.FAULT_RESET, *way)
    assert path(State.NOT_READY_TO_SWITCH_ON, State.READY_TO_SWITCH_ON) == way[:1]


def test_the_simulated_drive_has_the_same_table() -> None:
    """Its own, in C++: a row a state, a column a command; the first column is no command."""
    columns = [
        None, Command.DISABLE_VOLTAGE, Command.QUICK_STOP, Command.SHUTDOWN, Command.SWITCH_ON,
        Command.ENABLE_OPERATION, Command.FAULT_RESET,
    ]  # fmt: skip
    rows = _core._drive_transitions()
    assert (len(rows), len(rows[0])) == (len(State), len(columns))
    for state, row in zip(State, rows, strict=True):
        for command, then in zip(columns, row, strict=True):
            expected = state if command is None else after(state, command)
            assert State[then.name] is expected, (state, command)


def test_words_of_commands_are_those_of_the_standard() -> None:
    assert {c.name: int(c.word) for c in Command} == {
        "DISABLE_VOLTAGE": 0x00, "QUICK_STOP": 0x02, "SHUTDOWN": 0x06, "SWITCH_ON": 0x07,
        "ENABLE_OPERATION": 0x0F, "FAULT_RESET": 0x80,
    }  # fmt: skip
    assert Command.DISABLE_OPERATION is Command.SWITCH_ON
    assert Statusword(0x0227) & Statusword.REMOTE
