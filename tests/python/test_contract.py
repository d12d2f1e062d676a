"""What every law promises, tested over the one list of laws. A new law is tested by being in it."""

import copy
import math
import pickle
from collections import deque
from typing import Any

import numpy as np
import pytest
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st

import ebac

LAWS = list(ebac.LAWS)
PASSIVE = [name for name, law in ebac.LAWS.items() if law.passive]
#: Holds its last force when the motion stops, to the letter of the paper.
FREEZES = "ebac-printed"

every_law = pytest.mark.parametrize("name", LAWS)


def made(name: str, delay: int = 1) -> Any:
    return ebac.design(name, ebac.Device(), ebac.Timing(delay=delay))


def lively(name: str) -> Any:
    """The law with every memory it can have in use."""
    law = made(name, delay=2)
    return law.replace(kd=1e-3) if hasattr(law, "kd") else law


def bits(value: float) -> bytes:
    return np.float64(value).tobytes()


def random_ports(seed: int, n: int = 400, start: float = 0.0, drift: int = 0) -> list[ebac.Port]:
    """A wandering handle in and out of a stiff wall, on whole encoder counts, with standstills."""
    random = np.random.default_rng(seed)
    count = ebac.Device().count
    steps = (random.integers(-6, 7, n) + drift) * (random.random(n) < 0.7)
    steps[0] = 0
    ports, x = [], start
    for k, step in enumerate(steps):
        dx = float(step) * count
        x += dx
        ports.append(
            ebac.Port(
                x=x,
                dx=dx,
                v=dx / 1e-3,
                dt=1e-3 if k else 0.0,
                f_env=max(0.0, 1e4 * x),
                f_applied=float(random.normal(0, 5)),
                f_meas=float(random.normal(0, 5)),
            )
        )
    return ports


def drive(law: Any, ports: list[ebac.Port]) -> list[tuple[bytes, str]]:
    """Force and state after each step, to the bit; a NaN equals itself in text."""
    return [(bits(law.step(port)), repr(law.state.as_dict())) for port in ports]


# --- memory ---


@every_law
def test_the_same_run_twice_gives_the_same_bits(name: str) -> None:
    ports = random_ports(1)
    assert drive(lively(name), ports) == drive(lively(name), ports)


@every_law
def test_reset_forgets_everything(name: str) -> None:
    law = lively(name)
    fresh = drive(law, random_ports(1))
    drive(law, random_ports(2))
    law.reset()
    assert repr(law.state.as_dict()) == repr(lively(name).state.as_dict())
    assert drive(law, random_ports(1)) == fresh


@every_law
def test_a_copy_carries_its_state_and_runs_independently(name: str) -> None:
    ports = random_ports(3)
    whole = drive(lively(name), ports)
    law = lively(name)
    drive(law, ports[:200])
    twin = law.copy()
    drive(law, random_ports(4))  # must not reach the copy
    assert drive(twin, ports[200:]) == whole[200:]


@every_law
@pytest.mark.parametrize(
    "duplicate",
    [copy.copy, copy.deepcopy, lambda law: pickle.loads(pickle.dumps(law))],
    ids=["copy", "deepcopy", "pickle"],
)
def test_copying_and_pickling_give_a_fresh_equal_design(name: str, duplicate: Any) -> None:
    law = lively(name)
    fresh = drive(law.copy(), random_ports(5))
    drive(law, random_ports(6))
    twin = duplicate(law)
    assert twin is not law
    assert twin == law
    assert hash(twin) == hash(law)
    assert drive(twin, random_ports(5)) == fresh


# --- numbers ---

plausible = st.builds(
    ebac.Port,
    x=st.floats(-0.1, 0.1),
    dx=st.just(0.0) | st.floats(-0.01, 0.01),
    v=st.floats(-5, 5),
    dt=st.just(0.0) | st.floats(1e-4, 2e-3),
    f_env=st.just(0.0) | st.floats(-200, 200),
    f_applied=st.floats(-42.4, 42.4),
    f_meas=st.floats(-145, 145),
)
size = st.floats(1e-50, 1e50)  # beyond, squares and quotients leave the range of a double
huge = st.just(0.0) | size | size.map(lambda value: -value)
extreme = st.builds(
    ebac.Port,
    x=huge,
    dx=huge,
    v=huge,
    dt=st.just(0.0) | st.floats(1e-9, 1e3),
    f_env=huge,
    f_applied=huge,
    f_meas=huge,
)


@every_law
@given(ports=st.lists(plausible | extreme, min_size=1, max_size=30), delay=st.integers(0, 2))
def test_finite_in_is_finite_out_and_within_the_peak(
    name: str, ports: list[ebac.Port], delay: int
) -> None:
    law = made(name, delay)
    for port in ports:
        force = law.step(port)
        assert math.isfinite(force)
        assert abs(force) <= law.peak_force


@every_law
@pytest.mark.parametrize("start", [-0.02, 0.0])
def test_the_state_of_a_law_stays_finite(name: str, start: float) -> None:
    """From free air too. Only a slope dF/dx may be undefined, which is NaN."""
    law = made(name)
    ports = random_ports(7, 1000, start, drift=2)
    assert ports[-1].x > 0
    for port in ports:
        law.step(port)
        for column, value in law.state.as_dict().items():
            assert math.isfinite(value) or column.startswith("beta"), column


@every_law
@given(before=st.lists(plausible, max_size=20), x=st.floats(-0.1, -1e-6))
def test_at_rest_and_out_of_contact_there_is_no_force(
    name: str, before: list[ebac.Port], x: float
) -> None:
    law = made(name)
    for port in [] if name == FREEZES else before:
        law.step(port)
    law.step(ebac.Port(x=x, dt=1e-3))
    for _ in range(3):
        assert law.step(ebac.Port(x=x, dt=1e-3)) == 0


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


@every_law
def test_every_law_runs_to_the_end_without_a_fault(name: str, run: Any) -> None:
    trace = run(name, seconds=1.0)
    assert len(trace) == 1001
    assert (trace["fault"] == 0).all()


def test_what_a_python_law_raises_comes_out_as_it_was() -> None:
    with pytest.raises(ZeroDivisionError, match="by design"):
        ebac.simulate(ebac.Scenario(), After(10, ZeroDivisionError("by design")))


def test_what_the_reset_of_a_python_law_raises_comes_out_as_it_was() -> None:
    class NoReset(After):
        def reset(self) -> None:
            raise LookupError("no reset")

    with pytest.raises(LookupError, match="no reset"):
        ebac.simulate(ebac.Scenario(), NoReset(10, 0.0))


def test_a_python_law_that_gives_no_float_is_named() -> None:
    with pytest.raises((TypeError, ValueError, RuntimeError), match=r"(?i)cast|float|number"):
        ebac.simulate(ebac.Scenario(), After(10, "ten newtons"))


def test_a_python_law_is_copied_for_every_axis() -> None:
    law = After(5, 0.0)
    two = ebac.Device(kinematics=ebac.Linear(axes=2))
    trace = ebac.simulate(ebac.Scenario(device=two, seconds=0.02), law)
    assert law.tick == 0
    assert (trace["f_cmd"] == ([[1, 1]] * 5 + [[0, 0]] * 16)).all()


def test_a_core_law_wrapped_in_python_gives_the_same_bits() -> None:
    class Wrapped:
        def __init__(self) -> None:
            self.inner = made("ebac")

        def step(self, port: ebac.Port) -> float:
            return float(self.inner.step(port))

        def reset(self) -> None:
            self.inner.reset()

    scenario = ebac.Scenario(seconds=0.5)
    inside, outside = ebac.simulate(scenario, Wrapped()), ebac.simulate(scenario, "ebac")
    for column in ("x", "f_cmd", "f_applied", "true.x", "true.energy"):
        assert inside[column].tobytes() == outside[column].tobytes()


# --- parameters ---

FIELDS = [
    pytest.param(cls, field, id=f"{cls.__name__}.{field.name}")
    for cls in (*ebac.LAWS.values(), ebac.Timing)
    for field in cls.fields()
]
every_parameter = pytest.mark.parametrize(("cls", "field"), FIELDS)


def beyond(field: Any, bound: float, way: int) -> Any:
    """The next value past a bound."""
    return int(bound) + way if field.kind == "int" else math.nextafter(bound, way * math.inf)


def typed(field: Any, value: float) -> Any:
    return {"int": int, "bool": bool, "float": float}[field.kind](value)


@every_parameter
def test_every_parameter_has_a_unit_a_meaning_and_a_default(cls: Any, field: Any) -> None:
    assert field.unit
    assert len(field.meaning) > 2
    assert not field.meaning.endswith(".")
    assert getattr(cls(), field.name) == field.default
    assert field.low <= field.default <= field.high
    assert field.name in cls.__doc__
    assert field.meaning in cls.__doc__
    assert field.meaning in getattr(cls, field.name).__doc__


@every_parameter
def test_each_bound_of_a_parameter_is_accepted(cls: Any, field: Any) -> None:
    for bound in (field.low, field.high):
        assert math.isfinite(bound)
        value = typed(field, bound)
        assert getattr(cls(**{field.name: value}), field.name) == value


@every_parameter
def test_one_step_beyond_a_bound_is_refused_by_name(cls: Any, field: Any) -> None:
    if field.kind == "bool":  # it has no bounds, but neither are 2 and None switches
        for value in (2, None):
            with pytest.raises(
                TypeError, match=rf"{cls.__name__}\.{field.name} = {value}: must be bool"
            ):
                cls(**{field.name: value})
        return
    unit = "" if field.unit == "1" else f" {field.unit}"
    for bound, way in ((field.low, -1), (field.high, 1)):
        value = beyond(field, bound, way)
        with pytest.raises(ValueError) as caught:  # noqa: PT011
            cls(**{field.name: value})
        text = str(caught.value)
        assert text.startswith(f"{cls.__name__}.{field.name} = ")
        assert text.endswith(f"{unit}: must lie in [{field.low:g}, {field.high:g}]{unit}")


@pytest.mark.parametrize(("cls", "field"), [p for p in FIELDS if p.values[1].kind != "bool"])
def test_a_value_far_outside_is_shown_in_the_message(cls: Any, field: Any) -> None:
    value = typed(field, 2 * field.high + 1)
    with pytest.raises(ValueError) as caught:  # noqa: PT011
        cls(**{field.name: value})
    shown = str(caught.value).partition(f".{field.name} = ")[2].partition(":")[0].split()[0]
    assert float(shown) == value


@every_parameter
@pytest.mark.parametrize("value", [math.nan, "2", None, [1.0]], ids=repr)
def test_what_is_no_number_is_refused_by_name(cls: Any, field: Any, value: Any) -> None:
    with pytest.raises((ValueError, TypeError), match=rf"{cls.__name__}\.{field.name} = "):
        cls(**{field.name: value})


@every_law
def test_design_refuses_what_lies_out_of_range(name: str) -> None:
    with pytest.raises(ValueError, match=r"peak_force = -1 N: must lie in \[0.001, 10000\] N"):
        ebac.design(name, ebac.Device(), ebac.Timing(), peak_force=-1.0)


@every_law
def test_a_wrong_parameter_name_suggests_the_right_one(name: str) -> None:
    cls = ebac.LAWS[name]
    with pytest.raises(
        TypeError, match=r"no parameter 'peak_forse', did you mean 'peak_force'; it has: "
    ):
        cls(peak_forse=1.0)
    with pytest.raises(TypeError, match=r"did you mean 'peak_force'"):
        ebac.design(name, ebac.Device(), ebac.Timing(), peak_forse=1.0)


@every_law
def test_parameters_are_keyword_only_and_frozen(name: str) -> None:
    with pytest.raises(TypeError):
        ebac.LAWS[name](1.0)
    law = made(name)
    for field in law.fields():
        with pytest.raises(AttributeError):
            setattr(law, field.name, field.default)


@every_law
@given(data=st.data())
def test_repr_evaluates_to_an_equal_law(name: str, data: st.DataObject) -> None:
    cls = ebac.LAWS[name]
    values = {f.name: data.draw(value_of(f), f.name) for f in cls.fields()}
    timing = ebac.Timing(**{f.name: data.draw(value_of(f), f.name) for f in ebac.Timing.fields()})
    law = cls(**values, timing=timing)
    assert law.as_dict() == values | {"timing": timing}
    assert eval(repr(law), dict(vars(ebac))) == law
    for field_name, value in values.items():
        assert getattr(law, field_name) == value


def value_of(field: Any) -> st.SearchStrategy[Any]:
    if field.kind == "bool":
        return st.booleans()
    if field.kind == "int":
        return st.integers(int(field.low), int(field.high))
    return st.floats(field.low, field.high)


@every_law
def test_replace_changes_one_parameter_and_checks_it(name: str) -> None:
    law = made(name)
    other = law.replace(peak_force=7.0)
    assert other.peak_force == 7.0
    assert other != law
    assert other.replace(peak_force=law.peak_force) == law
    with pytest.raises(ValueError, match="peak_force"):
        law.replace(peak_force=-1.0)


@every_law
def test_a_law_is_designed_from_what_is_known_of_the_device(name: str) -> None:
    device, timing = ebac.Device(), ebac.Timing(dt=5e-4, delay=2)
    law = ebac.design(name, device, timing)
    assert law == ebac.LAWS[name].design(device.facts, timing)
    assert law.timing == timing
    for field in device.facts.fields():
        if hasattr(law, field.name):
            assert getattr(law, field.name) == getattr(device.facts, field.name)


@every_law
def test_a_law_has_a_name_a_summary_and_says_whether_it_is_passive(name: str) -> None:
    cls = ebac.LAWS[name]
    assert cls.name == name
    assert cls.summary in cls.__doc__
    assert isinstance(cls.passive, bool)


@every_law
def test_the_state_of_a_law_is_recorded_in_every_trace(name: str, run: Any) -> None:
    trace = run(name, seconds=1.0)
    told = {f"law.{f.name}": f for f in ebac.LAWS[name].State.fields()}
    assert {column for column in trace if column.startswith("law.")} == set(told)
    for column, field in told.items():
        assert trace.columns[column].unit == field.unit
        assert trace.columns[column].meaning == field.meaning


# --- one law, two ways to run it ---

WORLDS: dict[str, dict[str, Any]] = {
    "plain": {},
    "jitter and noise": {
        "jitter": 0.3,
        "device": ebac.Device(sensor=ebac.ForceSensor(noise=0.2, quantum=0.05)),
    },
    "friction": {"device": ebac.Device(mechanics=ebac.Mechanics(coulomb=1.0))},
    "two axes": {
        "device": ebac.Device(kinematics=ebac.Linear(axes=2)),
        "environment": ebac.Corner(),
        "hand": ebac.Hand(path=[ebac.Step(), ebac.Sine(frequency=3.0)]),
    },
}


@every_law
@pytest.mark.parametrize("delay", [0, 1, 2])
@pytest.mark.parametrize("world", WORLDS)
def test_stepping_from_python_equals_the_simulation_to_the_bit(
    name: str, delay: int, world: str
) -> None:
    scenario = ebac.Scenario(seconds=0.4, timing=ebac.Timing(delay=delay), **WORLDS[world])
    law = ebac.design(name, scenario.device, scenario.timing)
    rows = law._simulate(scenario.setup())
    trace = ebac.Trace.from_rows(rows, scenario=scenario, law=name, law_repr=repr(law))
    for axis in range(trace.axes):
        law.reset()
        for k in range(len(trace)):
            force = law.step(rows.port(k, axis))
            assert bits(force) == trace.axis("f_cmd", axis)[k].tobytes()
            for field in law.state.fields():
                told = trace.axis(f"law.{field.name}", axis)[k]
                assert (
                    np.asarray(getattr(law.state, field.name), told.dtype).tobytes()
                    == told.tobytes()
                )


@every_law
def test_the_columns_of_a_trace_hold_all_that_a_law_reads(name: str, run: Any) -> None:
    trace = run(name, seconds=1.0)
    law = ebac.design(name, trace.scenario.device, trace.scenario.timing)
    read = ("x", "dx", "v", "dt", "f_env", "f_applied", "f_meas")
    columns = [trace[column].tolist() for column in read]
    for k, values in enumerate(zip(*columns, strict=True)):
        assert law.step(ebac.Port(**dict(zip(read, values, strict=True)))) == trace["f_cmd"][k]


# --- passive means passive ---


def test_some_law_is_declared_passive() -> None:
    assert "eba" in PASSIVE
    assert "direct" not in PASSIVE


#: One tick of a hostile world: how it moves, what force it asks for, and dt / T.
moves = st.one_of(
    st.tuples(st.just("by"), st.just(0.0) | st.floats(-0.01, 0.01)),
    st.tuples(st.just("dearest"), st.floats(0, 2)),
)
asked = st.one_of(
    st.tuples(st.just("wall"), st.floats(0, 1e6)),
    st.tuples(st.just("force"), st.floats(-1e3, 1e3)),
    st.tuples(st.just("against"), st.floats(0, 1e3)),
)


def worlds(ticks: st.SearchStrategy[float]) -> st.SearchStrategy[list[Any]]:
    """Some ticks of one kind, then some of another."""
    stretch = st.tuples(st.tuples(moves, asked, ticks), st.integers(1, 10))
    return st.lists(stretch, max_size=8).map(
        lambda all_: [tick for tick, n in all_ for _ in range(n)]
    )


even, late = worlds(st.just(1.0)), worlds(st.floats(0.1, 1.9))


def bare(damping: float) -> ebac.DeviceFacts:
    """A device without lag and without counts: what the account of these worlds is exact for."""
    return ebac.DeviceFacts(damping=damping, current_lag=0, count=0)


def least_energy(law: Any, world: list[Any]) -> tuple[float, float]:
    """Lowest W + D of a law whose commands act `delay` ticks late, and the sum of all sizes.

    "dearest" is the displacement that takes the most energy out of the force that acts, -F / (2 B);
    "against" asks for the opposite of the last command.
    """
    b, timing = law.damping, law.timing
    law.reset()
    law.step(ebac.Port())
    under_way = deque([0.0] * (timing.delay + 1))
    x = energy = least = size = 0.0
    for (how, amount), (kind, strength), share in world:
        dt = share * timing.dt
        applied = under_way.popleft()
        dx = amount if how == "by" else -amount * applied * dt / (2 * b) if b > 0 else 0.0
        x += dx
        energy += applied * dx + b / dt * dx * dx
        size += abs(applied * dx) + b / dt * dx * dx
        least = min(least, energy)
        f_env = max(0.0, strength * x) if kind == "wall" else strength
        if kind == "against":
            f_env = -math.copysign(strength, under_way[-1] if under_way else applied)
        under_way.append(
            law.step(ebac.Port(x=x, dx=dx, v=dx / dt, dt=dt, f_env=f_env, f_applied=applied))
        )
    return least, size


@pytest.mark.parametrize("name", PASSIVE)
@settings(max_examples=400)
@given(
    world=even,
    delay=st.integers(0, 2),
    dt=st.sampled_from([2.5e-4, 1e-3, 4e-3]),
    b=st.floats(0.01, 50),
)
def test_a_passive_law_keeps_its_bound_in_any_world(
    name: str, world: list[Any], delay: int, dt: float, b: float
) -> None:
    law = ebac.design(name, bare(b), ebac.Timing(dt=dt, delay=delay))
    least, size = least_energy(law, world)
    assert least >= -1e-12 * (size + 1e-6)


@pytest.mark.parametrize("name", PASSIVE)
@settings(phases=[Phase.explicit, Phase.generate])
@given(world=late, delay=st.integers(0, 2))
@example(
    world=[(("by", 1e-3), ("force", 100.0), 1.0), (("dearest", 1.0), ("force", 0.0), 1.9)], delay=0
)
def test_a_passive_law_keeps_its_bound_when_ticks_come_late(
    name: str, world: list[Any], delay: int
) -> None:
    law = ebac.design(name, bare(2.0), ebac.Timing(delay=delay, jitter=0.45))
    least, size = least_energy(law, world)
    assert least >= -1e-12 * (size + 1e-6)


@pytest.mark.parametrize("delay", [0, 1, 2])
def test_the_hostile_world_does_break_a_law_without_a_bound(delay: int) -> None:
    class Spring:
        damping, timing = 2.0, ebac.Timing(delay=delay)

        def reset(self) -> None: ...

        def step(self, port: ebac.Port) -> float:
            return port.f_env

    world = [(("by", 1e-3), ("wall", 1e4), 1.0)] * 5 + [(("dearest", 1.0), ("wall", 1e4), 1.0)] * 5
    assert least_energy(Spring(), world)[0] < -1e-3
