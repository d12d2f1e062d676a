"""Wrong arguments of the functions and classes of one run: a sentence of ours, never another library's."""

import inspect
import pickle
import re
import sys
import threading
from collections.abc import Callable, Iterator
from enum import Enum
from typing import Any

import pytest
from typer.testing import CliRunner

import ebac
from ebac import _core
from ebac._util.arguments import LISTED_BY, near, number, unknown
from ebac.cli import app
from ebac.drives import bus_timing
from ebac.hardware import Configuration
from ebac.hardware.schedule import Order
from ebac.identify.check import check
from ebac.identify.gains.check import check_gains
from ebac.laws.tuned_laws import tuned_laws
from ebac.live.choices import Choices
from ebac.plot.save import millimetres
from ebac.realtime.jitter import beside_cyclictest
from ebac.sensor import SensorConfig

S: Any = ebac.Scenario
CONFIGURATION = Configuration.from_toml("")
has = "; it has: device, hand, environment, timing, seconds, jitter, seed, observer"


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: ebac.contact("x"),  # type: ignore[arg-type]
            "ebac.contact takes a trace, as ebac.simulate or ebac.load returns it, not 'x' (str)",
        ),
        (
            lambda: ebac.simulate("x"),  # type: ignore[arg-type]
            "ebac.simulate takes a Scenario, not 'x' (str)",
        ),
        (lambda: ebac.spec_sheet(3), "ebac.spec_sheet takes a Device, not 3 (int)"),  # type: ignore[arg-type]
        (lambda: ebac.ideal_rest(3), "ebac.ideal_rest takes a Scenario, not 3 (int)"),  # type: ignore[arg-type]
        (
            lambda: ebac.study(3),  # type: ignore[arg-type]
            "ebac.study takes a population, an Operators, not 3 (int)",
        ),
        (
            lambda: ebac.sweep(3, ["ebac"]),  # type: ignore[arg-type]
            "ebac.sweep takes a list of scenarios, not 3 (int)",
        ),
        (
            lambda: ebac.sweep([ebac.Scenario()], ["ebac"], limits=True),  # type: ignore[arg-type]
            "ebac.sweep takes limits=RunLimits(...), beyond which a run ends early "
            "(a device's own: ebac.simulate), not True (bool)",
        ),
        (
            lambda: ebac.Device(encoder=None),  # type: ignore[arg-type]
            "Device.encoder = None: is of the wrong kind; leave it out for the default",
        ),
        (
            lambda: ebac.Encoder(resolution=1e-5),  # type: ignore[call-arg]
            "Encoder has no parameter 'resolution': give counts_per_turn, of the motor: 2 pi x drum_radius x radius / "
            "sector_radius / (one count at the handle in m); for 10 um on the reference device 2 pi x 0.005 x 0.1 / "
            "0.1 / 10e-6 = 3142; it has: counts_per_turn, counter_bits",
        ),
        (
            lambda: ebac.zwidth(base="x"),  # type: ignore[arg-type]
            "ebac.zwidth takes a Scenario as its base, not 'x' (str)",
        ),
        (
            lambda: S(wall=1),
            f"Scenario has no parameter 'wall': give environment=ebac.Wall(...){has}",
        ),
        (
            lambda: S().replace(delay=2),
            "Scenario has no parameter 'delay': it belongs to Timing, timing=ebac.Timing(delay=...)"
            + has,
        ),
        (
            lambda: S(law="eba"),
            f"Scenario has no parameter 'law': a law is an argument of ebac.simulate{has}",
        ),
        (
            lambda: S(secnds=1),
            f"Scenario has no parameter 'secnds', did you mean 'seconds' or 'seed'{has}",
        ),
        (lambda: S(colour=1), f"Scenario has no parameter 'colour'{has}"),
        (
            lambda: S(3),
            f"Scenario takes its parameters by name, not 3 (int){has}",
        ),
        (lambda: S(device=3), "Scenario.device = 3: must be Device"),
    ],
)
def test_wrong_arguments_are_refused_with_a_sentence(
    call: Callable[[], object], message: str
) -> None:
    with pytest.raises(TypeError) as refused:
        call()
    assert str(refused.value) == message


@pytest.mark.parametrize("law", ["mine.py:Damped", "laws/mine.py:Damped", "mine:Damped"])
def test_a_law_in_the_words_of_the_command_line_is_refused_with_those_of_python(law: str) -> None:
    for call in (lambda: ebac.simulate(S(), law), lambda: ebac.sweep([S()], [law])):
        with pytest.raises(
            ValueError, match=r"from mine import Damped, and Damped\(\) in place of '"
        ):
            call()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ebac.Encoder().read("x"), "Encoder.read: angle = 'x': must be a number"),
        (
            lambda: ebac.Encoder().read(1, 2),
            "Encoder.read takes 1 value in order, not 2; it has: angle",
        ),
        (lambda: ebac.Encoder().read(), "Encoder.read needs angle; it has: angle"),
        (
            lambda: ebac.Encoder().read(angl=1),
            "Encoder.read has no parameter 'angl', did you mean 'angle'; it has: angle",
        ),
        (
            lambda: ebac.Encoder(count=5e-5),
            "Encoder has no parameter 'count': give counts_per_turn, of the motor; device.count is that at the handle; "
            "it has: counts_per_turn, counter_bits",
        ),
        (
            lambda: ebac.Timing(rate=2000),
            "Timing has no parameter 'rate': give dt, 1/rate; it has: dt, delay, jitter",
        ),
        (lambda: ebac.Encoder().unwrap(1.5, 2), "Encoder.unwrap: raw = 1.5: must be an integer"),
        (
            lambda: ebac.Encoder().unwrap(2**80, 2),
            f"Encoder.unwrap: raw = {2**80}: does not fit into the integer it is kept in",
        ),
        (lambda: ebac.Encoder.read(3, 4), "Encoder.read is a method of Encoder, not of 3 (int)"),
        (lambda: ebac.Wall().force(1, [0]), "Wall.force: x = 1: must be a list of numbers"),
        (lambda: ebac.Wall().as_dict(2), "Wall.as_dict takes no parameters, not 2 (int)"),
        (lambda: ebac.Wall().replace(3), "Wall.replace takes its parameters by name, not 3 (int)"),
        (lambda: setattr(ebac.Port(), "x", "a"), "Port.x = 'a': must be a number"),
        (lambda: ebac.EBAC().step(), "EBAC.step needs port; it has: port"),
        (lambda: ebac.Limits.of(3), "Limits.of: device = 3: must be a Device"),
        (
            lambda: ebac.sensor.SharedForce([1]),
            "SharedForce: force = [1]: must be a list of 3 numbers",
        ),
        (
            lambda: ebac.estimate_velocity(3, [1], 1, 1),
            "estimate_velocity: estimator = 3: must be a BackwardDifference, LowPass or AdaptiveWindow",
        ),
        (
            lambda: _core.Running(),
            "Running has no constructor: functions of ebac return objects of it",
        ),
        (
            lambda: ebac.simulate(S(), limits=3),
            "ebac.simulate takes limits=True, False or a Limits, not 3 (int)",
        ),
        (
            lambda: ebac.identify.fit_arm("arm.csv"),
            "ebac.identify.fit_arm takes a Recording, as ebac.identify.load returns it, not 'arm.csv' (str)",
        ),
        (
            lambda: ebac.simulate(S(seconds=0.01))["a":"b"],
            "trace['a':'b']: must be times [s], as in trace[1.0:2.5]",
        ),
        (
            lambda: ebac.testing.Tolerance(1),
            "Tolerance takes its parameters by name, not 1 (int); it has: absolute, relative",
        ),
        (
            lambda: ebac.identify.Limits(fors=1),
            "Limits has no parameter 'fors', did you mean 'force'; "
            "it has: overshoot, force, current, noise_gain, energy",
        ),
        (
            lambda: ebac.design("eba", ebac.Device(), ebac.Timing(), virtual_damping=30),
            "EBA has no parameter 'virtual_damping': it has no virtual damper; its damping is another thing, a lower "
            "bound of the physical damping of the device, and too high a value lets the law give out energy that "
            "nobody has put in; it has: damping, share, peak_force, timing",
        ),
        (lambda: ebac.Variant("ebac"), "Variant needs changes; it has: law, changes"),
    ],
)
def test_wrong_calls_of_methods_and_constructors_are_refused_in_our_words(
    call: Callable[[], object], message: str
) -> None:
    with pytest.raises(TypeError) as refused:
        call()
    assert str(refused.value) == message


def functions_of_the_core() -> Iterator[tuple[str, Any, tuple[Any, ...]]]:
    for name, value in vars(_core).items():
        if name.startswith("_"):
            continue
        if not isinstance(value, type):
            yield name, value, ()
        elif not issubclass(value, Enum):
            for member, bound in vars(value).items():
                if (
                    member != "open"
                    and not member.startswith("_")
                    and callable(getattr(value, member))
                ):
                    own = () if isinstance(bound, staticmethod) else (object(),)
                    yield f"{name}.{member}", getattr(value, member), own


def answer(function: Any, *values: object, **given: object) -> str:
    """Return the words by which a call is refused."""
    try:
        function(*values, **given)
    except (TypeError, ValueError, AttributeError) as refused:
        return str(refused)
    return "taken"


def test_no_function_of_the_core_answers_in_the_words_of_pybind11() -> None:
    answers = {
        f"{name}{values[:1]}{given}": answer(function, *own, *values, **given)
        for name, function, own in functions_of_the_core()
        for values, given in [((object(),) * 20, {}), ((), {"nobody": 1}), (("x",), {})]
    }
    assert len(answers) > 1000
    wrong = {
        call: words
        for call, words in answers.items()
        if words == "taken" or "incompatible" in words or "nvoked with" in words
    }
    assert not wrong


@pytest.mark.parametrize("name", ["EBAC", "Ebac"])
def test_a_law_that_does_not_exist_is_refused_with_the_nearest(name: str) -> None:
    with pytest.raises(
        KeyError, match=f"no law is called '{name}', did you mean 'ebac'; `ebac laws` lists all"
    ):
        ebac.simulate(S(), name)


def test_a_scenario_still_shows_its_signature() -> None:
    assert list(inspect.signature(ebac.Scenario).parameters) == [
        *("device", "hand", "environment", "timing", "seconds", "jitter", "seed", "observer")
    ]


def test_a_name_that_is_none_is_answered_with_the_nearest_and_with_what_lists_all() -> None:
    few, many = ["press", "tap", "rest"], [f"law-{i}" for i in range(30)]
    assert unknown("--hand tip", "tip", few) == (
        "--hand tip: no such name, did you mean 'tap'; there are: press, tap, rest"
    )
    assert unknown("--law x", "x", many, "law") == ("--law x: no such name; `ebac laws` lists all")
    assert near("PRESS", few) == ["press"]
    assert len(near("law-1x", many)) == 3
    assert near("virt", ["tca", "virtual-coupling"]) == ["virtual-coupling"]
    assert near("zzz", few) == []
    # Another word for the same.
    with pytest.raises(TypeError, match="'friction', did you mean 'coulomb'"):
        ebac.Mechanics(friction=0.1)  # type: ignore[call-arg]
    with pytest.raises(ValueError, match=r"friction: no such name: give coulomb in \[device\.mech"):
        ebac.Scenario.from_toml("[device]\nfriction = 0.1")
    with pytest.raises(ValueError, match="wall: no such name, did you mean 'environment'"):
        ebac.Scenario.from_toml("[wall]\nstiffness = 1e4")
    assert near("bet", ["law.beta", "x"]) == ["law.beta"]


def test_a_name_that_is_none_is_no_text_in_quotes() -> None:
    with pytest.raises(KeyError) as caught:
        ebac.simulate(S(), "ebca")
    assert str(caught.value).startswith("no law is called 'ebca', did you mean ")
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


class Locked:
    """A law that keeps what has no copy."""

    def __init__(self) -> None:
        self.gain = 1.0
        self.lock = threading.Lock()

    def step(self, port: ebac.Port) -> float:
        return port.f_env

    def reset(self) -> None:
        pass


class LockedHand(ebac.hands.OwnHand):
    """A hand that keeps what has no copy."""

    def __init__(self) -> None:
        self.lock = threading.Lock()

    def force(self, t: float, x: float, v: float) -> float:
        return 0.0


def test_a_law_or_hand_that_has_no_copy_is_refused_by_the_attribute() -> None:
    words = r"Locked\.lock: cannot be copied \(cannot pickle '_thread.lock' object\), and each axis and each run has a "
    for search in (ebac.simulate, lambda scenario, law: ebac.worst(law, "d1K10")):
        with pytest.raises(TypeError, match=words + "deep copy of a law"):
            search(S(seconds=0.1), Locked())
    with pytest.raises(TypeError, match=r"LockedHand\.lock: cannot be copied"):
        ebac.simulate(S(seconds=0.1, hand=LockedHand()), "ebac")


def test_a_search_takes_one_condition() -> None:
    with pytest.raises(TypeError, match="worst: condition takes one condition, such as 'd1K10'"):
        ebac.worst("ebac", ["d1K10"])  # type: ignore[arg-type]


def test_a_table_without_pandas_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    trace = ebac.simulate(S(seconds=0.1), "direct")
    with pytest.raises(ImportError, match="to_pandas needs pandas: pip install pandas"):
        trace.to_pandas()
    with pytest.raises(ImportError, match="to_pandas needs pandas: pip install pandas"):
        ebac.Operators.grid().to_pandas()


@pytest.mark.parametrize("kind", LISTED_BY)
def test_what_lists_the_names_of_a_kind_is_a_command(kind: str) -> None:
    words = LISTED_BY[kind].removeprefix("ebac ").split()
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output


def test_the_command_that_lists_laws_has_every_name() -> None:
    text = " ".join(CliRunner().invoke(app, ["laws"]).stdout.split())
    assert [name for name in (*ebac.LAWS, *tuned_laws()) if name not in text] == []


def test_what_belongs_to_the_scenario_is_said_to() -> None:
    with pytest.raises(TypeError, match=r"seconds belongs to the scenario.*replace\(seconds="):
        ebac.simulate(ebac.Scenario(), "ebac", seconds=2)
    assert len(ebac.simulate(ebac.Scenario(seconds=0.1), "ebac", observer=False)) == 101


def test_one_operator_can_be_chosen_by_its_number() -> None:
    hands = ebac.Operators.grid()
    assert hands[3] == hands[3:4]
    assert hands[-1] == hands[[59]]
    with pytest.raises(IndexError):
        hands[60]


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: ebac.sweep([1], ["ebac"]), "ebac.sweep takes a list of scenarios, each a Scenario, not 1"),
        (lambda: ebac.sweep([ebac.Scenario()], "ebac", seed="a"), "sweep: seed = 'a': must be a whole number"),
        (lambda: ebac.sweep([ebac.Scenario()], "ebac", designed_for=[1]), "designed_for takes pairs"),
        (lambda: ebac.design("ebac", ebac.Timing(), ebac.Device()), "ebac.design takes a Device"),
        (lambda: ebac.Wall(stiffness=True), "Wall.stiffness = True: must be a number in N/m"),
        (lambda: ebac.Timing(delay=True), "Timing.delay = True: must be a whole number in samples"),
    ],
)  # fmt: skip
def test_what_is_no_such_thing_is_refused_by_its_name(call: Any, says: str) -> None:
    with pytest.raises(TypeError, match=re.escape(says)):
        call()


def test_a_condition_that_gives_nothing_is_refused_by_its_name() -> None:
    nothing: Any = ebac.studies.Condition(
        name="none", summary="gives nothing", change=lambda s: None
    )
    with pytest.raises(TypeError, match="condition none takes a change that returns a Scenario"):
        ebac.study(ebac.Operators.grid()[:1], ["ebac"], [nothing])


def test_a_whole_number_beyond_a_double_is_refused_by_name() -> None:
    with pytest.raises(ValueError, match=r"amplitude = 1000000000\.\.\.: is too large"):
        number("amplitude", 10**400)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ebac.Timing(delay=10**400), "Timing.delay = inf samples: must lie in [0, 8] samples"),
        (lambda: ebac.Timing(delay=-(10**400)), "Timing.delay = -inf samples: must lie in [0, 8] samples"),
        (lambda: ebac.Wall(stiffness=10**400), "Wall.stiffness = inf N/m: must lie in [0, 1e+07] N/m"),
        (lambda: ebac.Linear(axes=2**40), "Linear.axes = 1099511627776: must lie in [1, 3]"),
        (lambda: CONFIGURATION.replace(soft_start=10**400), "Configuration.soft_start = inf s: must lie in [0, 60] s"),
        (lambda: CONFIGURATION.replace(memory=0.5), "memory = 0.5 s: must lie in [1, 3600] s"),
        (lambda: CONFIGURATION.scenario(seconds=10**400), "seconds = inf s: must lie in [0.01, 100000] s"),
        (lambda: Choices().with_changes({"stiffness": 10**400}), "stiffness = inf N/m: must lie in [100, 50000] N/m"),
        (lambda: Choices().with_changes({"delay": -(10**400)}), "delay = -inf samples: must lie in [1, 8] samples"),
        (lambda: ebac.live.Session(CONFIGURATION, max_stiffness=10**400), "max_stiffness = inf N/m: must be a number"),
        (lambda: Order.parse(f"1{'0' * 400} law.kp=0"), "must be a time of 0 s or more, then"),
        (lambda: bus_timing(ebac.drives.load("joystick"), dt=10**400), "dt = inf s: must lie in [0.0001, 1] s"),
        (lambda: bus_timing(ebac.drives.load("joystick"), seed=10**400), "seed = inf: must lie in [0, 2**64 - 1]"),
        (lambda: SensorConfig(port=10**400), "sensor.port = 1000"),
        (lambda: SensorConfig(sign=10**400), "sensor.sign = 1000"),
        (lambda: SensorConfig(gone=10**400), "sensor.gone = inf s: must lie in [0.001, 60] s"),
        (lambda: ebac.worst("eba", evaluations=10**400), "worst: evaluations = inf: must lie in [40, 1e+07]"),
        (lambda: ebac.zwidth(rungs=10**400), "zwidth: rungs = 1000"),
        (lambda: ebac.zwidth(epsilon=10**400), "zwidth: epsilon = 1000000000...: is too large"),
        (lambda: ebac.gastroscope.chain(seconds=10**400), "seconds = inf s: must lie in [1, 3600] s"),
        (lambda: check(arms=1, workers=10**400), "workers = 1000"),
        (lambda: check_gains(logs=1, evaluations=10**400), "evaluations = 1000"),
        (lambda: millimetres(10**400), "width = inf mm: must lie in [40, 1000] mm"),
        (lambda: beside_cyclictest(seconds=10**400), "seconds = 1000000000...: is too large"),
    ],
)  # fmt: skip
def test_a_whole_number_beyond_its_type_is_out_of_range(make: Any, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        make()
