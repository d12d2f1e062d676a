"""The configuration of a run: every refusal names file, line, value, unit, range and remedy."""

import copy
import dataclasses
import pickle
import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebac
from ebac.hardware import Configuration, ConfigurationError, designed
from ebac.hardware.rating import check_rating

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"

#: The axes of a small motion: straight, so that the workspace is a square.
FLAT = "[device.kinematics]\ntype = 'Linear'\naxes = 2\n"


def test_the_example_is_what_it_says() -> None:
    known = Configuration.load(EXAMPLE)
    assert known.device.axes == 2
    assert known.environment == ebac.Wall(stiffness=10e3, position=0.01)
    assert known.limits == ebac.Limits.of(known.device).replace(speed=1.0)
    assert [node.id for node in known.drives.nodes] == [1, 2]
    assert known.law == "ebac"
    assert known.hand.path[0] == ebac.MinimumJerk(target=0.04, at=0.5, duration=1.0)
    assert known.text == EXAMPLE.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "why"),
    [
        (
            "nope.toml",
            "there is no such file; give the path of a configuration, of which `ebac demo",
        ),
        (".", r"cannot be read \(Is a directory\); give the path of a configuration"),
    ],
)
def test_a_file_that_cannot_be_read_is_said_in_a_sentence(
    tmp_path: Path, name: str, why: str
) -> None:
    path = tmp_path / name
    with pytest.raises(ConfigurationError, match=f"^{re.escape(str(path))}: {why}"):
        ebac.Device.open(path)


def test_an_empty_one_is_the_paper_s_joystick() -> None:
    known = Configuration.from_toml("")
    assert known.device == ebac.presets.device("joystick")
    assert known.setup == "verify"
    assert known.seconds == 10


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("[bus]\nchanel = 'can0'\n", 2, "bus.chanel: no such name, did you mean 'channel'"),
        ("[bus]\n\ninterface = 'kvaser'\n", 3, "bus.interface = 'kvaser'"),
        (
            "[bus]\ninterface = 'udp_multicast'\n",
            2,
            "a loop runs over no other interface of python-can",
        ),
        ("[bus]\nsilent = 0\n", 2, "silent = 0 samples: must lie in [1, 1000] samples"),
        ("[bus]\ndrives = 'nobody'\n", 2, "there is no such file"),
        ("[device]\npreset = 'robot'\n", 2, "no device is called 'robot'"),
        ("[device.mechanics]\ndamping = -3\n", 2, "damping = -3 N s/m"),
        (
            "[law]\nname = 'ebac'\n[device.sensor]\nlag = 0.001\nnoise = 30\n",
            5,
            "device.sensor.noise = 30 N: must lie in [0, 10] N, as EBAC.force_noise follows from it",
        ),
        (
            "[law]\nname = 'lag-compensator'\n[device.mechanics]\nhandle_mass = 0.02\n[device.motor]\n"
            "rotor_inertia = 0.0\n[timing]\ndelay = 1\ndt = 0.05\n",
            9,
            "timing.dt = 0.05 s (20 Hz): for it, 1 sample of delay and a device of 0.02 kg the design of "
            "LagCompensator gives stiffness = 0.3889 N/m, which must lie in [1, 1e+06] N/m; give",
        ),
        (
            "[limits]\nspeed = 1.0\n[device.motor]\ntorque_constant = 54\n",
            3,
            "device.motor: rated_torque = 0.053 N m and torque_constant = 54 N m/A give limits.continuous_current = "
            "0.000981481 A: must",
        ),
        (
            "[limits]\nspeed = 1.0\n[device.motor]\nrated_torque = 53\n",
            3,
            "device.motor: rated_torque = 53 N m and",
        ),
        ("[timing]\ndelay = 1\ndt = 1\n", 3, "dt = 1 s: must lie in"),
        ("[environment]\ntype = 'Wall'\nstiffness = -1.0\n", 3, "environment.stiffness = -1 N/m"),
        (
            "[environment]\ntype = 'Wall'\nposition = 10.0\n",
            3,
            "environment.position = 10 m: must be less than 0.05427 m",
        ),
        (
            f"{FLAT}[environment]\ntype = 'Wall'\nangle = 0.785\nposition = 0.082\n",
            7,
            "must be less than 0.08112 m",
        ),
        (
            "[limits]\nedge = 0.02\nend = 0.03\n[environment]\nposition = 0.04\n",
            5,
            "limits.end = 0.03 m",
        ),
        (
            "[environment]\ntype = 'Corner'\nsecond = { angle = 1.57, position = 10.0 }\n",
            3,
            "environment.second.position = 10 m",
        ),
        (
            "[environment]\ntype = 'Disc'\nx = 0.01\ny = 3.0\n",
            4,
            "environment.y = 3 m: the handle never",
        ),
        ("[law]\nname = 'ebaac'\n", 2, "did you mean 'ebac'"),
        ("[law]\nname = 'ebac'\nkq = 1\n", 3, "law.kq: no such name"),
        (
            "[law]\nname = 'ebac'\nvirtual_damping = 30.0\n",
            3,
            "law.virtual_damping: ebac has no parameter virtual_damping; it is designed, and injection = 0 leaves it "
            "out; its damping is another thing, "
            "a lower bound of the physical damping of the device",
        ),
        ("[law]\nname = 'ebac'\nkp = 7.0\n", 3, "kp = 7"),
        (
            "[timing]\ndelay = 0\n",
            2,
            "timing.delay = 0 samples: over a CAN bus a command acts one tick later at the earliest; must lie in "
            "[1, 8] samples",
        ),
        (
            "[limits]\npeak_current = 0.5\n",
            2,
            "limits.peak_current = 0.5 A: lies below limits.continuous_current, 0.9851 A, which follows from the motor",
        ),
        ("[limits]\nspeed = 0.0\n", 2, "limits.speed = 0 m/s: must lie in [0.001, 100] m/s"),
        ("[limits]\nedge = 0.06\nend = 0.05\n", None, "end"),
        ("[run]\nseconds = 'long'\n", 2, 'run.seconds = "long": must be a number in s'),
        ("[run]\nsoft_start = 61.0\n", 2, "must lie in [0, 60] s"),
        ("[realtime]\nmode = 'hard'\n", 2, "realtime.mode = 'hard'"),
        ("[realtime]\npriority = 100\n", 2, "realtime.priority = 100: must lie in [1, 99]"),
        ("[recording]\nmemory = 0.5\n", 2, "recording.memory = 0.5 s: must lie in [1, 3600] s"),
        ("[simulated.hand]\nmass = -1.0\n", 2, "simulated.hand.mass = -1 kg"),
        ("[simulated]\nhands = 2\n", 2, "did you mean 'hand'"),
        ("speed = 1\n", 1, "speed: stands in no table; write [limits] in a line above it"),
        ("interface = 'ebac'\n", 1, "interface: stands in no table; write [bus]"),
        ("bus = 3\n", 1, "bus = 3: must be a table"),
        ("[device.kinematics]\ntype = 'Linear'\naxes = 1\n", None, "2 drives, the device 1 axis"),
        (
            "[device.kinematics]\ntype = 'Linear'\n",
            None,
            "It has no table of a configuration of `ebac run`, such as [bus]: if it is a scenario or a device",
        ),
        (
            "[limits]\nspeed = 0,5\n",
            None,
            "not a TOML document: Expected newline or end of document after a statement (at line 2, column 10); "
            "give numbers a decimal point: 0.5",
        ),
        (
            "[limits]\nspeed = 0.5 m/s  # not more\n",
            None,
            "Expected newline or end of document after a statement (at line 2, column 13); "
            "a number has no unit in TOML: leave out m/s, and give it in SI units",
        ),
        ("[device.motor]\ntorque_constant = 0.06\n", None, "motor.torque_constant = 0.0538"),
        (
            "[device.motor]\ntorque_constant = 0.06\n",
            None,
            "the built-in joystick and the device are for different motors",
        ),
        ("[sensor]\nhost = '10.0.0.1'\nport = 70000\n", 3, "port = 70000"),
        ("[sensor]\ncounts_per_forc = 1.0\n", 2, "did you mean 'counts_per_force'"),
        (
            "[signs]\nmotor = [1]\n",
            2,
            "signs.motor = [1]: must be a list of 1 or -1 for each of the 2",
        ),
        ("[signs]\nencoder = [1, 0]\n", 2, "signs.encoder = [1, 0]: must be a list of 1 or -1"),
        ("[signs]\nmotors = [1, 1]\n", 2, "did you mean 'motor'"),
        ("[run\n", None, "not a TOML document"),
        (
            "[limits]\nspeed = 1\n[limits]\nedge = 0.05\n",
            None,
            "the table [limits] is there twice (at line 3",
        ),
        (
            "[simulated.hand]\n[simulated.hand]\n",
            None,
            "not a TOML document: the table [simulated.hand] is there twice (at line 2",
        ),
        (
            "[environment]\ntype = 'Free'\nstiffness = 1e3\n",
            None,
            "environment.stiffness: no such name in Free; it has none: leave it out",
        ),
    ],
)
def test_what_cannot_be_is_refused_with_its_line(text: str, line: int | None, words: str) -> None:
    with pytest.raises(ConfigurationError) as refused:
        Configuration.from_toml(text, name="mine.toml")
    message = str(refused.value)
    assert words in message, message
    assert message.startswith("mine.toml")
    if line is not None:
        assert f"line {line}:" in message, message


@pytest.mark.parametrize(
    "world",
    [
        "type = 'Wall'\nposition = 0.055\n",  # between limits.edge and limits.end
        "type = 'Wall'\nposition = 0.06\nmotion_amplitude = 0.005\n",
        "type = 'Wall'\nangle = 0.785\nposition = 0.08\n",  # in the corner of the workspace
        "type = 'Disc'\nx = 0.09\ny = 0.05\nradius = 0.04\n",
        "type = 'Free'\n",
    ],
)
def test_a_world_within_reach_is_taken(world: str) -> None:
    assert Configuration.from_toml(f"{FLAT}[environment]\n{world}")


def test_a_wall_behind_the_stops_is_refused() -> None:
    table = f"{FLAT}radius = 0.12\nlimit = 0.2\n[environment]\ntype = 'Wall'\nposition = "
    with pytest.raises(ConfigurationError, match=r"position = 0\.04 m: must be less than 0\.029 m"):
        Configuration.from_toml(table + "0.04\n")
    limits = Configuration.from_toml(table + "0.01\n").limits
    assert (limits.edge, limits.end) == pytest.approx((0.019, 0.029))


def test_a_number_out_of_range_is_named_by_its_key_and_a_second_one_too() -> None:
    motor = "[device.motor]\nrotor_inertia = -3.45e-06\n"
    with pytest.raises(ConfigurationError) as refused:
        Configuration.from_toml(motor, name="mine.toml")
    said = str(refused.value)
    assert said.startswith("mine.toml, line 2: device.motor.rotor_inertia = -3.45e-06 kg m^2: must")
    assert "`ebac keys device." in said
    with pytest.raises(ConfigurationError, match=r"device\.motor\.rotor_inertia is given a second"):
        Configuration.from_toml(motor + "rotor_inertia = 1e-6\n")


def test_a_limit_beyond_the_motor_names_file_and_line() -> None:
    text = f"{FLAT}[limits]\npeak_current = 40.0 # A\n"
    with pytest.raises(ConfigurationError, match=r"^mine\.toml, line 5: limits\.peak_current = 40"):
        check_rating(Configuration.from_toml(text, name="mine.toml"))


def test_signs_are_those_of_the_axes() -> None:
    known = Configuration.from_toml("[signs]\nmotor = [1, -1]\n")
    assert known.signs == ebac.hardware.Signs(motor=(1, -1))
    assert known.simulated_signs is None


def test_without_a_sensor_nothing_is_fed_back() -> None:
    known = Configuration.from_toml("")
    assert known.design().kp == 0  # type: ignore[attr-defined]
    felt = Configuration.from_toml("[sensor]\nhost = '10.0.0.1'\n")
    assert felt.sensor is not None
    assert felt.design().kp > 0  # type: ignore[attr-defined]
    with pytest.raises(ValueError, match="the device has no force sensor"):
        designed("tca", {"kp": 0.2}, known.device, known.timing, sensor=False)


def test_a_law_in_python_is_refused() -> None:
    class Mine:
        def step(self, port: ebac.Port) -> float:
            return 0.0

        def reset(self) -> None:
            pass

    known = Configuration.from_toml("")
    with pytest.raises(TypeError, match="written in Python"):
        designed(Mine(), {}, known.device, known.timing, sensor=False)


_WORDS = st.sampled_from(
    ["bus", "device", "law", "run", "limits", "timing", "environment", "hand", "simulated", "type"]
)
_VALUES = st.one_of(
    st.integers(-(2**40), 2**40),
    st.floats(),
    st.booleans(),
    st.text(max_size=5),
    st.lists(st.integers(0, 3), max_size=2),
)


@given(
    st.dictionaries(
        _WORDS,
        st.one_of(
            _VALUES, st.dictionaries(st.one_of(_WORDS, st.text(max_size=6)), _VALUES, max_size=3)
        ),
        max_size=4,
    )
)
@settings(max_examples=100, deadline=None)
def test_any_document_is_read_or_refused(table: dict[str, object]) -> None:
    import tomli_w

    try:
        Configuration.from_toml(tomli_w.dumps(table))
    except ConfigurationError as error:
        assert str(error).startswith("configuration")  # noqa: PT017


def test_a_configuration_is_copied_and_goes_to_another_process() -> None:
    """Its profiles have read-only values, which neither pickle nor copy takes."""
    known = ebac.datasets.joystick()
    for same in (pickle.loads(pickle.dumps(known)), copy.deepcopy(known)):
        assert same == known
        assert same.drives.nodes[0].profile.values == known.drives.nodes[0].profile.values


# --- the first run ---


def test_a_first_run_is_in_free_air_with_small_limits_and_else_the_same() -> None:
    text = "[engine]\ncommand = 'python mine.py'\n[limits]\nspeed = 0.5\nend = 0.07\n[sensor]\n"
    known = Configuration.from_toml(text).replace(law="tca", observer=True)
    first = known.first_run()
    small = {"peak_current": 0.1, "continuous_current": 0.1}
    assert first.limits == known.limits.replace(**small)
    assert first.limits.speed == 0.5, "lower than 1 m/s"
    assert first.environment == ebac.Free()
    assert first.engine == ""
    law: Any = first.design()
    assert law == known.design().replace(kp=0.0)
    same = {"environment", "engine", "changes", "limits", "text"}
    for one in dataclasses.fields(first):
        if one.name not in same:
            assert getattr(first, one.name) == getattr(known, one.name), one.name
    assert first.text.startswith(known.text)
    assert "\n# environment: free air instead of the engine, python mine.py\n" in first.text
    assert "\n# law.kp: 0 instead of 0.5, so that" in first.text
    assert (
        "\n# limits.peak_current: 0.1 A (1.08 N at the handle) instead of 3.941 A\n" in first.text
    )
    assert "speed: " not in first.text
    again = Configuration.from_toml(first.text)
    assert again.limits == known.limits, "what differs are comments"


@pytest.mark.parametrize("law", ["tca-damped", "ebac"])
def test_a_first_run_has_no_force(law: str) -> None:
    """Where the law of the file pushes against a hand in its wall."""
    known = Configuration.load(EXAMPLE).replace(law=law, seconds=1.5)
    assert abs(known.simulate()["f_cmd"]).max() > 1
    trace = known.first_run().simulate()
    assert abs(trace["x"]).max() > 0.03, "beyond where the wall was"
    assert not trace["f_cmd"].any()
    assert not trace["current"].any()


def test_a_simulated_hand_takes_a_model_as_that_of_a_scenario_does() -> None:
    """It was refused unless the preset had one."""
    table = 'type = "FingerPad"\nstiffness = 300.0\n'
    hand = Configuration.from_toml(f"[simulated.hand.model]\n{table}").hand
    assert hand == ebac.Scenario.from_toml(f"[hand.model]\n{table}").hand
    assert hand.model == ebac.hands.FingerPad(stiffness=300.0)
    with pytest.raises(
        ConfigurationError, match=r"line 3: simulated\.hand\.model\.stiffness = -1 N"
    ):
        Configuration.from_toml('[simulated.hand.model]\ntype = "FingerPad"\nstiffness = -1.0\n')
    with pytest.raises(ConfigurationError, match=r"line 2: simulated\.hand\.model"):
        Configuration.from_toml("[simulated.hand]\nmodel = 3\n")
