"""What every law promises: the contract of `ebac.testing` on the one list of laws, and what it stands on.

A new law is tested by being in the list.
"""

import math
import pickle
import re
from typing import Any

import numpy as np
import pytest

import ebac
from ebac.testing import LawContract, assert_passive
from ebac.testing.contract import FieldContract
from ebac.testing.contract.passivity import PUMP, least_energy
from ebac.testing.contract.subject import Subject

#: Holds its last force when the motion stops, to the letter of the paper.
FREEZES = "ebac-printed"


class TestLaws(LawContract):
    laws = tuple(law for name, law in ebac.LAWS.items() if name != FREEZES)

    def test_a_limit_of_force_is_refused_and_suggested_by_its_name(self, subject: Any) -> None:
        with pytest.raises(ValueError, match=r"peak_force = -1 N: must lie in \[0.001, 10000\] N"):
            ebac.design(subject.core, ebac.Device(), ebac.Timing(), peak_force=-1.0)
        with pytest.raises(TypeError, match=r"did you mean 'peak_force'; it has: "):
            subject.core(peak_forse=1.0)

    def test_what_is_known_of_the_device_goes_into_the_law(self, subject: Any) -> None:
        facts, law = ebac.Device().facts, subject.made()
        for field in facts.fields():
            if hasattr(law, field.name):
                assert getattr(law, field.name) == getattr(facts, field.name)


class TestPrintedLaw(LawContract):
    law = FREEZES
    holds_force = True


class TestValues(FieldContract):
    """Whatever has a field list and is no law."""

    @classmethod
    def owners(cls) -> list[Any]:
        public = (getattr(ebac, name) for name in dir(ebac))
        known = {ebac.Linear, *ebac.LAWS.values()}
        return [
            c for c in public if isinstance(c, type) and hasattr(c, "fields") and c not in known
        ]


class TestLinear(FieldContract):
    #: `axes`, which all kinematics have, has a docstring of its own.
    test_every_parameter_has_a_unit_a_meaning_and_a_default = None  # type: ignore[assignment]

    @classmethod
    def owners(cls) -> list[Any]:
        return [ebac.Linear]


def test_no_law_is_forgotten() -> None:
    tested = {s.name for contract in (TestLaws, TestPrintedLaw) for s in contract.subjects()}
    assert tested == set(ebac.LAWS)


def made(name: str, delay: int = 1) -> Any:
    return ebac.design(name, ebac.Device(), ebac.Timing(delay=delay))


def test_the_printed_law_freezes_its_force_where_the_others_let_go() -> None:
    law = made(FREEZES)
    law.step(ebac.Port(dt=0.0))
    law.step(ebac.Port(x=1e-3, dx=1e-3, dt=1e-3, f_env=10.0))
    assert law.step(ebac.Port(x=1e-3, dt=1e-3)) != 0


@pytest.mark.parametrize("name", ["tca", "ebac-printed"])
def test_a_force_loop_feeds_the_sensor_back_in_free_air(name: str) -> None:
    law = made(name)
    assert law.step(ebac.Port(x=-0.01, dt=1e-3, f_meas=2.0)) == -law.kp * 2.0  # eq. (2)


# --- faults ---


class After:
    """A law that gives `normal` until tick `k`, then `last`."""

    def __init__(self, k: int, last: Any, normal: float = 1.0) -> None:
        self.k, self.last, self.normal = k, last, normal
        self.tick = 0

    def reset(self) -> None:
        self.tick = 0

    def step(self, port: ebac.Port) -> Any:
        self.tick += 1
        if self.tick <= self.k:
            return self.normal
        if isinstance(self.last, Exception):
            raise self.last
        return self.last


def fault_of(scenario: ebac.Scenario, law: Any) -> ebac.LoopFault:
    with pytest.raises(ebac.LoopFault) as caught:
        ebac.simulate(scenario, law)
    return caught.value


def assert_stopped(error: ebac.LoopFault, fault: ebac.Fault, tick: int | None = None) -> None:
    """The fault latched and its force is zero from that tick on."""
    trace = error.trace
    first = int((trace["fault"] != 0).argmax())
    assert error.fault is fault
    assert tick in (None, first)
    assert (trace["fault"][first:] == int(fault)).all()
    for column in ("f_cmd", "tau", "current"):
        assert (trace[column][first:] == 0).all(), column
    assert len(trace) == first + 10  # then the loop ends
    delay = trace.scenario.timing.delay if trace.scenario else 0
    assert (trace["current_applied"][first + delay + 1 :] == 0).all()
    assert fault.name.lower().replace("_", " ") in str(error)
    assert f"tick {first}" in str(error)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("delay", [0, 1, 2])
@pytest.mark.parametrize("axes", [1, 2])
def test_a_law_that_gives_no_number_ends_in_a_latched_fault(
    value: float, delay: int, axes: int
) -> None:
    scenario = ebac.Scenario(
        device=ebac.Device(kinematics=ebac.Linear(axes=axes)), timing=ebac.Timing(delay=delay)
    )
    error = fault_of(scenario, After(50, value))
    assert_stopped(error, ebac.Fault.LAW_NOT_FINITE, 50)
    assert (error.trace["f_cmd"][:50] == 1).all()
    assert "fault 4 (law not finite: After gave no finite force) in tick 50" in str(error)


def test_a_torque_that_overflows_ends_in_a_latched_fault() -> None:
    long_lever = ebac.Device(
        kinematics=ebac.Linear(radius=10.0), capstan=ebac.Capstan(sector_radius=10.0)
    )
    error = fault_of(ebac.Scenario(device=long_lever), After(20, 1.7e308))
    assert_stopped(error, ebac.Fault.TORQUE_NOT_FINITE, 20)


def test_an_infinite_pull_ends_in_a_latched_fault() -> None:
    pull = ebac.Recorded(t=[0.0, 0.01, 0.02], x=[0.0, 0.0, 1.7e308])
    error = fault_of(ebac.Scenario(hand=ebac.Hand(path=pull)), "direct")
    assert_stopped(error, error.fault)
    assert error.fault in (ebac.Fault.DEVICE, ebac.Fault.POSITION_NOT_FINITE)


def test_what_a_python_law_raises_ends_the_run_by_its_name() -> None:
    error = fault_of(ebac.Scenario(), After(10, ZeroDivisionError("by design")))
    said = r"the law After raised ZeroDivisionError: by design \(test_contract.py, line \d+\)\) in tick 10,"
    assert re.search(said, str(error))
    assert isinstance(error.__cause__, ZeroDivisionError)
    assert error.remedy == ""
    assert len(error.trace) == 20
    assert (error.trace["f_cmd"][:10] == 1).all()


def test_a_law_that_asks_a_port_for_what_it_has_not_is_told_what_it_has() -> None:
    class Wrong(After):
        def step(self, port: ebac.Port) -> float:
            return port.force  # type: ignore[attr-defined,no-any-return]

    text = str(fault_of(ebac.Scenario(seconds=0.5), Wrong(0, 0.0)))
    assert "a port has no 'force', did you mean 'f_meas' or 'f_env'; it has: " in text
    assert "world_v, x" in text


def test_what_the_reset_of_a_python_law_raises_ends_the_run_by_its_name() -> None:
    class NoReset(After):
        name = "unset"

        def reset(self) -> None:
            raise LookupError("no reset")

    error = fault_of(ebac.Scenario(), NoReset(10, 0.0))
    said = r"the law unset raised LookupError: no reset \(test_contract.py, line \d+\)\) in tick 0,"
    assert re.search(said, str(error))


def test_an_error_in_a_python_law_ends_a_comparison() -> None:
    law = After(10, ZeroDivisionError("by design"))
    for compare in (
        lambda: ebac.studies.shapes((law,), worlds=("sphere",), devices=("joystick",)),
        lambda: ebac.studies.engines(laws=(law,), rates=(60.0,)),
        lambda: ebac.sweep([ebac.Scenario(seconds=0.1)], law),
    ):
        with pytest.raises(ebac.LoopFault, match="the law After raised ZeroDivisionError"):
            compare()


def test_a_fault_comes_back_from_another_process() -> None:
    error = fault_of(ebac.Scenario(seconds=0.1), After(10, math.nan))
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.fault, again.remedy) == (str(error), error.fault, error.remedy)
    assert again.trace["f_cmd"].tobytes() == error.trace["f_cmd"].tobytes()


def test_an_interrupt_in_a_python_law_comes_out_as_it_was() -> None:
    class Stopped(After):
        def step(self, port: ebac.Port) -> float:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ebac.simulate(ebac.Scenario(), Stopped(10, 0.0))


class NoPort(After):
    def step(self) -> float:  # type: ignore[override]
        return 0.0


class TwoPorts(After):
    def step(self, port: ebac.Port, other: ebac.Port) -> float:  # type: ignore[override]
        return 0.0


class ResetsTo(After):
    def reset(self, tick: int) -> None:  # type: ignore[override]
        self.tick = tick


@pytest.mark.parametrize(
    ("law", "message"),
    [
        (NoPort, "NoPort.step() is called with the port of one axis: write it as step(self, port)"),
        (
            TwoPorts,
            "TwoPorts.step(port, other) is called with the port of one axis: write it as step(self, port)",
        ),
        (ResetsTo, "ResetsTo.reset(tick) is called with nothing: write it as reset(self)"),
    ],
)
def test_a_python_law_with_other_arguments_is_told_how_to_take_them(law: Any, message: str) -> None:
    for run in (
        lambda: ebac.simulate(ebac.Scenario(seconds=0.1), law(10, 1.0)),
        lambda: ebac.sweep([ebac.Scenario(seconds=0.1)], [law(10, 1.0)]),
    ):
        with pytest.raises(TypeError, match=re.escape(message)):
            run()


class NoReset:
    def step(self, port: ebac.Port) -> float:
        return 0.0


class NoStep:
    def reset(self) -> None:
        pass


@pytest.mark.parametrize(
    ("law", "message"),
    [
        (NoReset(), "NoReset is no law: it needs reset()"),
        (NoStep(), "NoStep is no law: it needs step(port) -> float"),
        (3, "3 (int) is no law: it needs step(port) -> float and reset()"),
    ],
)
def test_what_a_class_lacks_to_be_a_law_is_named(law: Any, message: str) -> None:
    with pytest.raises(TypeError, match=f"^{re.escape(message)}$"):
        ebac.simulate(ebac.Scenario(seconds=0.1), law)


@pytest.mark.parametrize("answer", ["ten newtons", None, np.zeros(2), [1.0], {}])
def test_a_python_law_that_gives_no_number_is_named_with_its_answer(answer: Any) -> None:
    text = f"After.step returned {answer!r}: must return the force [N] of one axis, a number"
    error = fault_of(ebac.Scenario(), After(10, answer))
    assert f"the law After raised TypeError: {text}" in str(error)


@pytest.mark.parametrize("answer", [1, True, np.float32(1), np.array(1.0)])
def test_a_python_law_may_give_any_number(answer: Any) -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.02), After(10, answer))
    assert trace["f_cmd"][-1] == 1.0


def test_a_python_law_is_copied_for_every_axis() -> None:
    law = After(5, 0.0)
    two = ebac.Device(kinematics=ebac.Linear(axes=2))
    trace = ebac.simulate(ebac.Scenario(device=two, seconds=0.02), law)
    assert law.tick == 0
    assert (trace["f_cmd"] == ([[1, 1]] * 5 + [[0, 0]] * 16)).all()


@pytest.mark.parametrize("observer", [False, True])
def test_a_core_law_wrapped_in_python_gives_the_same_bits(observer: bool) -> None:
    class Wrapped:
        def __init__(self, observer: bool) -> None:
            self.observer = observer
            self.inner = made("ebac")

        def step(self, port: ebac.Port) -> float:
            return float(self.inner.step(port))

        def reset(self) -> None:
            self.inner.reset()

    scenario = ebac.Scenario(seconds=0.5)
    law = ebac.Variant("ebac", {"observer": observer})
    inside, outside = ebac.simulate(scenario, Wrapped(observer)), ebac.simulate(scenario, law)
    for column in ("x", "f_cmd", "f_applied", "true.x", "true.energy"):
        assert inside[column].tobytes() == outside[column].tobytes()


# --- passive means passive ---


def test_some_law_is_declared_passive() -> None:
    passive = {name for name, law in ebac.LAWS.items() if law.passive}
    assert passive == {"eba-account", "force-bounding"}
    assert "direct" not in passive


class Spring:
    """The world's force and no bound at all."""

    def reset(self) -> None: ...

    def step(self, port: ebac.Port) -> float:
        return port.f_env


@pytest.mark.parametrize("delay", [0, 1, 2])
def test_the_hostile_world_does_break_a_law_without_a_bound(delay: int) -> None:
    assert least_energy(Spring(), PUMP, 2.0, ebac.Timing(delay=delay))[0] < -1e-3


def test_a_simulated_wall_does_break_a_law_without_a_bound() -> None:
    with pytest.raises(AssertionError, match=r"not passive: the port energy falls to -\d"):
        assert_passive(ebac.simulate(ebac.Scenario(seconds=1.0), Spring()))


def test_a_law_that_needs_arguments_is_told_how_a_contract_makes_it() -> None:
    with pytest.raises(TypeError) as refused:
        Subject.of(After, LawContract)
    assert "write law = lambda: After(...)" in refused.value.__notes__[0]


class _Held:
    """A law in Python, of which few tests can be asked."""

    name = "held"

    def step(self, port: Any) -> float:
        return float(port.f_env)

    def reset(self) -> None:
        pass


def test_a_contract_that_inherits_asks_all_that_its_own_law_can_be_asked() -> None:
    """What the law of the first could not be asked was left out for that of the second, too."""

    class OfPython(LawContract):
        __test__ = False
        law = _Held

    class OfCore(OfPython):
        law = "eba-account"

    class Alone(LawContract):
        __test__ = False
        law = "eba-account"

    def tests(contract: type) -> set[str]:
        return {n for n in dir(contract) if n.startswith("test_") and getattr(contract, n)}

    assert tests(OfCore) == tests(Alone) > tests(OfPython)


class Lag:
    """Follows the world with a lag, or at a limited rate of its force [N per tick]."""

    def __init__(self, share: float, rate: float = math.inf) -> None:
        self.share, self.rate, self.force = share, rate, 0.0

    def reset(self) -> None:
        self.force = 0.0

    def step(self, port: ebac.Port) -> float:
        change = self.share * (port.f_env - self.force)
        self.force += max(-self.rate, min(self.rate, change))
        return self.force


@pytest.mark.parametrize(
    "law", [Lag(0.02), Lag(0.9), Lag(1.0, rate=1e-3), Lag(1.0, rate=2.0), Lag(1.0, rate=100.0)]
)
def test_the_first_case_of_free_air_catches_every_lag_and_limit_of_rate(law: Lag) -> None:
    class Slow(LawContract):
        __test__ = False

    Slow.law = law
    (subject,) = Slow.subjects()
    with pytest.raises(AssertionError, match="N at rest in free air, at -1 mm; a law that may"):
        Slow().test_at_rest_and_out_of_contact_there_is_no_force(subject)
    Slow.holds_force = True
    Slow().test_at_rest_and_out_of_contact_there_is_no_force(subject)


def test_a_finished_law_is_tested_on_the_device_that_it_was_made_for() -> None:
    class Finished(LawContract):
        __test__ = False
        law = ebac.design("eba-account", ebac.Device(), ebac.Timing())

    (subject,) = Finished.subjects()
    assert not subject.designed
    assert Subject.of("eba-account", Finished).designed
