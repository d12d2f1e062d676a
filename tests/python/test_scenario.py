"""The scenario: TOML and back, ranges, messages, and the manners of a value."""

import copy
import dataclasses
import math
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebac

#: What a repr is made of.
PUBLIC = {name: getattr(ebac, name) for name in ebac.__all__}

# --- any scenario at all ---


def value_of(field: Any) -> st.SearchStrategy[Any]:
    if field.kind == "bool":
        return st.booleans()
    if field.kind == "int":
        return st.integers(int(field.low), int(field.high))
    if math.isinf(field.high):
        return st.just(math.inf) | st.floats(field.low, 1e6)
    return st.floats(field.low, field.high)


def any_of(cls: Any, **parts: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    values = {field.name: value_of(field) for field in cls.fields()}
    return st.builds(cls, **(values | parts))


recorded = st.builds(
    lambda t, x: ebac.Recorded(t=sorted(t), x=x),
    st.lists(st.floats(0, 100), min_size=3, max_size=3, unique=True),
    st.lists(st.floats(-1, 1), min_size=3, max_size=3),
)
paths = st.one_of(
    *[any_of(c) for c in (ebac.Step, ebac.MinimumJerk, ebac.Sine, ebac.Tapping)], recorded
)
walls = any_of(ebac.Wall)
still = walls.map(lambda wall: wall.replace(motion_amplitude=0.0))
devices = st.builds(
    ebac.Device,
    kinematics=any_of(ebac.Linear) | any_of(ebac.Gimbal),
    motor=any_of(ebac.Motor),
    drive=any_of(ebac.Drive),
    encoder=any_of(ebac.Encoder),
    capstan=any_of(ebac.Capstan),
    mechanics=any_of(ebac.Mechanics, cable_stiffness=st.floats(1, 1e8)),
    sensor=any_of(ebac.ForceSensor),
    velocity=any_of(ebac.LowPass)
    | any_of(ebac.AdaptiveWindow)
    | st.just(ebac.BackwardDifference()),
    compensation=any_of(ebac.Compensation, inertia=st.floats(0, 5e-4)),
)
scenarios = st.builds(
    ebac.Scenario,
    device=devices,
    hand=any_of(ebac.Hand, path=paths | st.lists(paths, min_size=1, max_size=3)),
    environment=walls | st.just(ebac.Free()) | st.builds(ebac.Corner, first=still, second=still),
    timing=any_of(ebac.Timing),
    seconds=st.floats(0.1, 1e5) | st.integers(1, 100),
    jitter=st.floats(0, 0.45),
    seed=st.integers(0, 2**63 - 1),
)


@given(scenario=scenarios)
@settings(max_examples=150)
@pytest.mark.slow
def test_toml_and_back_is_the_same_scenario(scenario: ebac.Scenario) -> None:
    text = scenario.to_toml()
    again = ebac.Scenario.from_toml(text)
    assert again == scenario
    assert again.to_toml() == text


@given(scenario=scenarios)
@settings(max_examples=50)
def test_pickling_and_copying_give_an_equal_scenario(scenario: ebac.Scenario) -> None:
    for twin in (
        pickle.loads(pickle.dumps(scenario)),
        copy.deepcopy(scenario),
        copy.copy(scenario),
    ):
        assert twin == scenario
        assert hash(twin) == hash(scenario)


@given(scenario=scenarios)
@settings(max_examples=50)
def test_repr_evaluates_to_an_equal_scenario(scenario: ebac.Scenario) -> None:
    assert eval(repr(scenario), PUBLIC) == scenario


def test_a_file_and_back_is_the_same_scenario(tmp_path: Path) -> None:
    scenario = ebac.Scenario(seconds=2.5, hand=ebac.presets.hand("arm-hogan"))
    scenario.save(tmp_path / "one.toml")
    assert ebac.Scenario.load(tmp_path / "one.toml") == scenario
    assert ebac.Scenario.load(str(tmp_path / "one.toml")) == scenario


def test_toml_of_the_default_is_readable() -> None:
    text = ebac.Scenario().to_toml()
    assert text.startswith("# ebac scenario; SI units throughout\n")
    for line in ("[device.mechanics]", 'type = "Wall"', "stiffness = 10000.0", "seconds = 6.0"):
        assert line in text.splitlines(), line


def test_a_configuration_of_a_run_is_no_scenario_and_the_reverse(tmp_path: Path) -> None:
    run = Path(__file__).parents[2] / "examples" / "joystick.toml"
    with pytest.raises(ValueError, match=r"joystick\.toml: this is a configuration of `ebac run`"):
        ebac.Scenario.load(run)
    path = tmp_path / "mine.toml"
    ebac.Scenario().save(path)
    with pytest.raises(ValueError, match=r"mine\.toml, line 2: seconds: this is a scenario"):
        ebac.hardware.Configuration.load(path)
    with pytest.raises(ValueError, match=r"seconds: stands in no table; write \[run\]"):
        ebac.hardware.Configuration.from_toml("seconds = 3\n[bus]\nchannel = 'can0'\n")


def test_what_toml_does_not_name_keeps_its_default() -> None:
    assert ebac.Scenario.from_toml("") == ebac.Scenario()
    assert ebac.Scenario.from_toml("[hand]\nmass = 0.3") == ebac.Scenario(hand=ebac.Hand(mass=0.3))
    expected = ebac.Scenario(device=ebac.Device(kinematics=ebac.Gimbal()), environment=ebac.Free())
    text = '[device.kinematics]\ntype = "Gimbal"\n[environment]\ntype = "Free"'
    assert ebac.Scenario.from_toml(text) == expected
    assert ebac.Scenario.from_toml("[environment]\nstiffness = 5e3").environment == ebac.Wall(
        stiffness=5e3
    )


def test_whole_numbers_stand_for_real_ones() -> None:
    assert ebac.Scenario.from_toml("seconds = 2\n[hand]\nmass = 1") == ebac.Scenario(
        seconds=2.0, hand=ebac.Hand(mass=1.0)
    )


@pytest.mark.parametrize(
    "given",
    [
        {"seconds": np.float64(2.5)},
        {"seconds": np.int64(2)},
        {"seconds": np.float32(0.1), "jitter": np.float32(0.1)},
        {"seed": np.int64(7), "observer": np.bool_(True)},
    ],
)
def test_a_number_of_numpy_is_one_of_python(given: dict[str, Any]) -> None:
    scenario = ebac.Scenario(**given)
    assert scenario == ebac.Scenario(**{name: value.item() for name, value in given.items()})
    assert ebac.Scenario.from_toml(scenario.to_toml()) == scenario
    (run,) = ebac.sweep([scenario.replace(seconds=0.1)], "ebac")["seed"].tolist()
    assert run == scenario.seed


# --- messages ---


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "secnds = 1",
            "secnds: no such name, did you mean 'seconds' or 'seed'; there are: device, hand",
        ),
        ("[hnd]\nmass = 1", "hnd: no such name, did you mean 'hand'"),
        (
            "[hand]\nmas = 1",
            "hand.mas: no such name, did you mean 'mass'; it has: mass",
        ),
        ("[device.motr]", "device.motr: no such name, did you mean 'motor'"),
        ("[hand]\nmass = -1", "hand.mass = -1 kg: must lie in [0, 10] kg"),
        ("[hand]\nmass = 'a'", "hand.mass = 'a': must be a number in kg"),
        ("[hand]\nmass = nan", "hand.mass = nan kg: must lie in"),
        (
            "[timing]\ndelay = 1.5",
            "timing.delay = 1.5: must be a whole number in samples",
        ),
        (
            "[timing]\ndelay = 9",
            "timing.delay = 9 samples: must lie in [0, 8] samples",
        ),
        (
            "[device.drive]\npermille = 2",
            "device.drive.permille = 2: must be true or false",
        ),
        (
            "[device.encoder]\ncounts_per_turn = 0",
            "device.encoder.counts_per_turn = 0 counts",
        ),
        (
            "[environment]\ntype = 'Fog'",
            "environment.type = 'Fog': no such name; there are: Wall, Free, Corner",
        ),
        (
            "[environment]\ntype = 'Free'\nstiffness = 1",
            "environment.stiffness: no such name",
        ),
        (
            "[environment]\ntype = 'World'\n[[environment.body]]\nfriction = 0.3",
            "environment.body: no such name in World, did you mean 'bodies'; it has: bodies",
        ),
        (
            "[environment]\ntype = 'World'",
            "environment: World needs bodies; it has: bodies",
        ),
        (
            "[environment]\ntype = 'Bridge'\nhold = true",
            "environment.hold: no such name in Bridge, did you mean 'held' or 'world'; it has: world",
        ),
        (
            "[environment]\ntype = 'World'\n[[environment.bodies]]\nsolid = {type = 'Mesh', path = 'ring.stl'}",
            "environment.bodies[0].solid.path: no such name in Mesh: did you mean 'file'; it has: file",
        ),
        (
            "[environment]\ntype = 'World'\n[[environment.bodies]]\nsolid = {type = 'Union', solid = []}",
            "environment.bodies[0].solid.solid: no such name in Union, did you mean 'solids'",
        ),
        (
            "[hand]\nmotor = 3",
            "hand.motor: no such name; it has: mass",
        ),
        (
            "[environment]\ntype = 'Corner'\n[environment.first]\ndamping = -1",
            "environment.first.damping = -1 N s/m: must lie in [0, 10000] N s/m",
        ),
        (
            "[[hand.path]]\ntarget = 1\n[[hand.path]]\ntype = 'Sine'\nfrequency = -1",
            "hand.path[1].frequency = -1 Hz: must lie in [0, 500] Hz",
        ),
        (
            "[[hand.path]]\ntype = 'Recorded'\nt = [0.0, 0.0]\nx = [0.0, 0.0]",
            "hand.path[0]: Recorded: time does not rise at point 1",
        ),
        (
            "[device.mechanics]\nbacklash = 1e-3",
            "device.mechanics.backlash = 0.001 m: needs",
        ),
        ("hand = 3", "hand = 3: must be a table"),
        ("seconds = 'long'", "seconds = 'long': must be a number in s"),
        ("seconds = true", "seconds = True: must be a number in s"),
        ("seed = 1.0", "seed = 1.0: must be a whole number"),
        ("jitter = 0.5", "jitter = 0.5: must lie in [0, 0.45] of a sample"),
        ("seconds = [", "not a TOML document: "),
        (
            "[device.mechanics]\nhandle_mass = 0,09\n",
            "(at line 2, column 16); give numbers a decimal point: 0.09",
        ),
        ("[hand]\nname = a,b\n", "not a TOML document: "),
    ],
)
def test_a_wrong_document_is_refused_and_the_message_says_where(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        ebac.Scenario.from_toml(text)


@pytest.mark.parametrize(
    ("key", "remedy"),
    [
        ("mass", "give handle_mass in [device.mechanics] without the rotor's share; it has"),
        ("damping", "device.damping: no such name: give damping in [device.mechanics]; it has"),
    ],
)
def test_a_file_is_told_its_own_table_not_python(key: str, remedy: str, tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    path.write_text(f"[device]\n{key} = 0.3\n")
    with pytest.raises(ValueError, match=re.escape(remedy)):
        ebac.Scenario.load(path)


def test_the_message_names_the_file(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text("secnds = 1")
    with pytest.raises(ValueError, match=r"bad\.toml, line 1: secnds: no such name"):
        ebac.Scenario.load(path)
    with pytest.raises(FileNotFoundError):
        ebac.Scenario.load(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"seconds": 0.0}, r"Scenario\.seconds = 0\.0 s: must lie in \(0, 100000\] s"),
        ({"seconds": math.nan}, r"Scenario\.seconds = nan s"),
        ({"seconds": math.nextafter(1e5, 1e6)}, r"Scenario\.seconds = 100000\.0\d* s"),
        (
            {"seconds": 9e-4},
            r"Scenario\.seconds = 0\.0009 s: must be at least one sample, 0\.001 s",
        ),
        ({"jitter": -1e-9}, r"Scenario\.jitter = -1e-09"),
        ({"jitter": math.nextafter(0.45, 1)}, r"Scenario\.jitter = 0\.45"),
        ({"seed": -1}, r"Scenario\.seed = -1: must lie in \[0, 2\^63\)"),
        ({"seed": 2**63}, r"Scenario\.seed = 9223372036854775808"),
    ],
)
def test_a_number_out_of_range_is_refused_by_name(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ebac.Scenario(**changes)


@pytest.mark.parametrize(
    "changes",
    [
        {"seconds": 1e-3},
        {"seconds": 1e5},
        {"jitter": 0.45},
        {"jitter": 0},
        {"seed": 0},
        {"seed": 2**63 - 1},
    ],
)
def test_a_number_at_its_bound_is_accepted(changes: dict[str, Any]) -> None:
    scenario = ebac.Scenario(**changes)
    for name, value in changes.items():
        assert getattr(scenario, name) == value


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("device", ebac.Hand()),
        ("hand", None),
        ("environment", "wall"),
        ("timing", 1e-3),
        ("seconds", "6"),
        ("seconds", True),
        ("jitter", None),
        ("seed", 1.0),
        ("seed", True),
    ],
)
def test_a_part_of_a_wrong_type_is_refused_by_name(name: str, value: Any) -> None:
    with pytest.raises(TypeError, match=rf"Scenario\.{name} = "):
        ebac.Scenario(**{name: value})


# --- manners ---


def test_a_scenario_is_frozen_and_keyword_only() -> None:
    scenario = ebac.Scenario()
    for field in dataclasses.fields(scenario):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(scenario, field.name, getattr(scenario, field.name))
    with pytest.raises(TypeError):
        ebac.Scenario(ebac.Device())


def test_replace_checks_again() -> None:
    scenario = ebac.Scenario().replace(seconds=1.0)
    assert scenario.seconds == 1.0
    assert ebac.Scenario().seconds == 6.0
    with pytest.raises(ValueError, match="seconds"):
        scenario.replace(seconds=-1.0)
    with pytest.raises(TypeError):
        scenario.replace(secnds=1.0)


VALUES = [
    ebac.AdaptiveWindow(),
    ebac.BackwardDifference(),
    ebac.Capstan(),
    ebac.Compensation(),
    ebac.Corner(),
    ebac.Device(),
    ebac.DeviceFacts(),
    ebac.Drive(),
    ebac.Encoder(),
    ebac.ForceSensor(),
    ebac.Free(),
    ebac.Gimbal(),
    ebac.Hand(),
    ebac.Linear(),
    ebac.LowPass(),
    ebac.Mechanics(),
    ebac.MinimumJerk(),
    ebac.Motor(),
    ebac.Recorded(t=[0.0, 1.0], x=[0.0, 0.1]),
    ebac.Sine(),
    ebac.Step(),
    ebac.Tapping(),
    ebac.Timing(),
    ebac.Wall(),
]
every_value = pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)


@every_value
def test_a_value_is_frozen_hashable_and_equal_to_its_twins(value: Any) -> None:
    cls = type(value)
    for twin in (
        cls(**value.as_dict()),
        eval(repr(value), PUBLIC),
        pickle.loads(pickle.dumps(value)),
        copy.copy(value),
        copy.deepcopy(value),
        value.replace(),
    ):
        assert twin == value
        assert hash(twin) == hash(value)
    assert value != 1
    for name in value.as_dict():
        with pytest.raises(AttributeError):
            setattr(value, name, getattr(value, name))


@pytest.mark.parametrize("seconds", [[1.0], [1.0, 2.0]])
def test_an_array_is_no_number(seconds: list[float]) -> None:
    """One value was taken, and of two NumPy said that it cannot convert them, without a name."""
    given: Any = np.array(seconds)
    with pytest.raises(TypeError, match=r"Scenario\.seconds = array\(.*\): must be a number in s"):
        ebac.Scenario(seconds=given)


@pytest.mark.parametrize("world", [ebac.Corner(), ebac.Disc(), ebac.Wall(angle=np.pi / 2)])
def test_a_world_one_axis_would_never_feel_is_refused(world: Any) -> None:
    with pytest.raises(ValueError, match=r"needs 2 axes, the device has 1; give a device with"):
        ebac.simulate(ebac.Scenario(environment=world), "direct")


def test_a_path_for_an_axis_the_device_does_not_have_is_refused() -> None:
    hand = ebac.Hand(path=[ebac.Step(), ebac.Step(target=0.01)])
    with pytest.raises(ValueError, match=r"hand\.path\[1\] = Step.*the device has 1 axis"):
        ebac.simulate(ebac.Scenario(hand=hand), "direct")


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("[device.motor]\n\ntorque_constant = -1\n", 3, "device.motor.torque_constant = -1 N m/A"),
        (
            "seconds = 1.0\n[timing]\ndt = 1e-3\ndely = 1\n",
            4,
            "timing.dely: no such name, did you mean 'delay'; it",
        ),
        ("[hand]\nmas = 1\n", 2, "hand.mas: no such name, did you mean 'mass'; it has: mass"),
        (
            "[environment]\ntype = 'Free'\nstiffness = 1\n",
            3,
            "environment.stiffness: no such name in Free; it has none",
        ),
        ("# of mine\nsecnds = 3\n", 2, "secnds: no such name"),
        ("[[hand.path]]\ntype = 'Step'\ntarget = 99\n", 3, r"hand\.path\[0\]\.target = 99 m"),
        ("seconds = -1\n", 1, "seconds = -1 s"),
        ("[environment]\ntype = 'Wal'\n", 2, "environment.type = 'Wal'"),
    ],
)
def test_an_error_of_a_file_names_its_line(
    text: str, line: int, words: str, tmp_path: Path
) -> None:
    file = tmp_path / "s.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=rf"s\.toml, line {line}: {words}"):
        ebac.Scenario.load(file)


PRESET = '[device]\npreset = "joystick"\n[device.mechanics]\ngravity = 0.0\n[hand]\npreset = "finger"\nmass = 0.02\n'


def test_a_device_and_a_hand_may_start_from_a_preset() -> None:
    found = ebac.Scenario.from_toml(PRESET)
    joystick = ebac.presets.device("joystick")
    carried = joystick.mechanics.replace(gravity=0.0)
    assert found.device == joystick.replace(mechanics=carried)
    assert found.hand == ebac.presets.hand("finger").replace(mass=0.02)
    assert ebac.Scenario.from_toml(found.to_toml()) == found


def test_a_preset_and_a_run_configuration_give_the_same_device() -> None:
    tables = PRESET.partition("[hand]")[0]
    known = ebac.hardware.Configuration.from_toml(tables, name="mine")
    assert ebac.Scenario.from_toml(tables).device == known.device


@pytest.mark.parametrize(
    ("was", "given", "message"),
    [
        ('"joystick"', '"joystik"', r"device\.preset: no device is called 'joystik', did you mean"),
        ("gravity", "gravty", r"device\.mechanics\.gravty: no such name, did you mean 'gravity'"),
        ("mass = 0.02", "mass = -1.0", r"hand\.mass = -1 kg: must lie in \[0, 10\] kg"),
        ("gravity = 0.0", 'gravity = "no"', r"device\.mechanics"),
    ],
)  # fmt: skip
def test_what_stands_on_a_preset_is_refused_by_its_name(was: str, given: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ebac.Scenario.from_toml(PRESET.replace(was, given))
