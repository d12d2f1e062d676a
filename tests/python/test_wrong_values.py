"""Wrong values of public functions: a sentence that names function or parameter, never an error from deep inside."""

import re
import resource
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ebac
from ebac import drives, identify, worlds
from ebac.worlds import solids

E: Any = ebac
W: Any = worlds
SOLIDS = ", ".join(kind.__name__ for kind in solids.SOLIDS)


@pytest.fixture(scope="module")
def trace() -> Any:
    return ebac.simulate(ebac.Scenario(seconds=0.05), "direct")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda t: E.load(3), "ebac.load takes the path of a file, not 3 (int)"),
        (lambda t: E.load(None), "ebac.load takes the path of a file, not None (NoneType)"),
        (lambda t: t.save(3), "Trace.save takes the path of a file, not 3 (int)"),
        (lambda t: E.Scenario.load(3), "Scenario.load takes the path of a file, not 3 (int)"),
        (lambda t: E.Scenario.from_toml(3), "Scenario.from_toml takes text, not 3 (int)"),
        (
            lambda t: E.hardware.Configuration.load(3),
            "Configuration.load takes the path of a file, not 3 (int)",
        ),
        (
            lambda t: E.hardware.Configuration.from_toml(3),
            "Configuration.from_toml takes text, not 3 (int)",
        ),
        (lambda t: E.Device.open(3), "Configuration.load takes the path of a file, not 3 (int)"),
        (
            lambda t: E.identify.load(3),
            "ebac.identify.load takes the path of a file, not 3 (int)",
        ),
        (
            lambda t: E.drives.load(3),
            "ebac.drives.load takes the path of a file or the name of a profile, not 3 (int)",
        ),
        (
            lambda t: E.Scenario(hand=E.hands.LetGo),
            "Scenario.hand = the class LetGo (call it: LetGo()): must be Hand",
        ),
        (
            lambda t: E.Scenario(hand=E.Free()),
            "Scenario.hand = Free(): must be Hand",
        ),
        (
            lambda t: E.Hand(model=E.hands.LetGo),
            "Hand.model = the class LetGo (call it: LetGo()): must be Reflex, FingerPad, NonlinearGrip, LetGo, an "
            "object with force(t, x, v), or None",
        ),
        (
            lambda t: E.Device().replace(motor=E.Motor),
            "Device.motor = the class Motor (call it: Motor()): must be a Motor",
        ),
        (
            lambda t: E.worlds.World(E.worlds.Sphere),
            "World: the class Sphere (call it: Sphere()): must be a Body or a solid of ebac.worlds",
        ),
        (
            lambda t: E.simulate(E.Scenario, "ebac"),
            "ebac.simulate takes a Scenario, not the class Scenario (call it: Scenario())",
        ),
        (
            lambda t: E.replay(3, "ebac"),
            "ebac.replay takes a Trace, a Log or the path of one, not 3 (int)",
        ),
        (
            lambda t: E.sensor.Sensor.open(3),
            "ebac.sensor.Sensor takes a SensorConfig, not 3 (int)",
        ),
        (lambda t: E.drives.parse_eds(5), "parse_eds takes the text of an EDS, not 5 (int)"),
        (lambda t: t.axis("x", "y"), "axis = 'y': must be a whole number"),
        (lambda t: E.contact(t, axis="y"), "axis = 'y': must be a whole number"),
        (lambda t: t.head("a"), "rows = 'a': must be a whole number"),
        (lambda t: E.Operators.sample("x", 1), "Operators.sample: n = 'x': must be a whole number"),
        (
            lambda t: E.Operators.sample(3, "x"),
            "Operators.sample: seed = 'x': must be a whole number",
        ),
        (
            lambda t: E.Operators.from_columns(None),
            "Operators.from_columns takes columns by name, not None (NoneType)",
        ),
        (lambda t: W.preset(3), "ebac.worlds.preset takes the name of a world, not 3 (int)"),
        (
            lambda t: E.Variant("ebac", [1]),
            "ebac.Variant takes changes by name, as in {'kp': 0.2}, not [1] (list)",
        ),
        (
            lambda t: E.identify.Target.steps("a"),
            "Target.steps takes times [s], not 'a' (str)",
        ),
        (
            lambda t: identify.fit_arm(identify.Recording.from_trace(t), "held"),
            "ebac.identify.fit_arm takes a Target, such as Target.held(), or one for each recording, not 'held' (str)",
        ),
        (
            lambda t: E.sweep("base", "ebac"),
            "ebac.sweep takes a list of scenarios, not 'base' (str)",
        ),
        (
            lambda t: E.plot.plot_walls("walls"),
            "ebac.plot.plot_walls takes a Trace, or several, not 'walls' (str)",
        ),
        (lambda t: E.plot.plot_trace(3), "ebac.plot.plot_trace takes a Trace, not 3 (int)"),
        (lambda t: E.plot.plot_world(3), "ebac.plot.plot_world takes a World, not 3 (int)"),
        (lambda t: E.plot.save(3, "x.png"), "ebac.plot.save takes a Figure, not 3 (int)"),
        (
            lambda t: E.teleop.simulate("ebac", there=3),
            "teleop.simulate: there = 3 (int): must be a Link",
        ),
        (
            lambda t: E.teleop.simulate("ebac", slave=1),
            "teleop.simulate: slave = 1 (int): must be a SlaveModel",
        ),
        (
            lambda t: E.teleop.simulate(3),
            "teleop.simulate takes the name of a scheme or a Scheme, not 3 (int)",
        ),
        (
            lambda t: E.teleop.simulate(seconds="x"),
            "teleop.simulate: seconds = 'x': must be a number",
        ),
        (
            lambda t: E.teleop.simulate(seed=1.5),
            "teleop.simulate: seed = 1.5: must be a whole number",
        ),
        (lambda t: E.EBAC(timing=3), "EBAC.timing = 3: must be a Timing"),
        (lambda t: E.EBAC(kp=[1]), "EBAC.kp = [1]: must be a number"),
        (
            lambda t: E.EBAC.design(3, E.Timing()),
            "EBAC.design: facts = 3: must be a Device or DeviceFacts",
        ),
        (lambda t: E.tracking.error_budget(runs="x"), "runs = 'x': must be a whole number"),
        (
            lambda t: E.tracking.ErrorSources(slack="x"),
            "ErrorSources.slack = 'x': must be a number",
        ),
        (
            lambda t: W.EngineThread(lambda x, v: None, rate="x"),
            "EngineThread.rate = 'x': must be a number",
        ),
        (lambda t: W.Mesh("x.stl", scale="a"), "Mesh.scale = 'a': must be a number"),
        (
            lambda t: W.Mesh("x.stl", cell="a"),
            "Mesh.cell = 'a': must be a number",
        ),
        (lambda t: W.Mesh("x.stl", thickness=None), "Mesh.thickness = None: must be a number"),
        (
            lambda t: W.HeightField([[0, 0], [0, "a"]]),
            "HeightField.heights = [[0, 0], [0, 'a']] (list): must be numbers, shape (n, m)",
        ),
        (
            lambda t: W.HeightField([[0, 0], [0]]),
            "HeightField.heights = [[0, 0], [0]] (list): must be numbers, shape (n, m)",
        ),
        (
            lambda t: W.HeightField([[0, 0], [0, 0]], spacing="a"),
            "HeightField.spacing = 'a': must be a number",
        ),
        (
            lambda t: W.HeightField([[0, 0], [0, 0]], base="a"),
            "HeightField.base = 'a': must be a number",
        ),
        (
            lambda t: W.Placed(W.Sphere(), at=("abc", 0, 0)),
            "Placed.at = ('abc', 0, 0) m: must be three numbers in [-10, 10] m",
        ),
        (
            lambda t: W.Placed(W.Sphere(), at=5),
            "Placed.at = 5 m: must be three numbers in [-10, 10] m",
        ),
        (
            lambda t: W.Tube([(0, 0, 0), (0, 0, "a")]),
            "Tube.points = [(0, 0, 0), (0, 0, 'a')] (list): must be numbers, shape (n, 3)",
        ),
        (
            lambda t: W.Tube([(0, 0, 0), (0, 0, 1)], radius="a"),
            "Tube.radius = 'a' (str): must be a number, or one for each point",
        ),
        (
            lambda t: W.Tube.along([(0, 0, 0), (0, 0)]),
            "Tube.along: points = [(0, 0, 0), (0, 0)] (list): must be numbers, shape (n, 3)",
        ),
        (lambda t: W.Body(solid=W.Plane(), friction="a"), "Body.friction = 'a': must be a number"),
        (
            lambda t: W.Body(solid=W.Plane(), friction=True),
            "Body.friction = True: must be a number",
        ),
        (
            lambda t: W.World(W.Plane()).walk([["a", 0, 0]]),
            "World.walk: x = [['a', 0, 0]] (list): must be numbers, shape (n, 3)",
        ),
        (
            lambda t: W.LocalModel(at=(0, 0, 0), normal=(1, 0, 0), stiffness="a"),
            "LocalModel.stiffness = 'a': must be a number",
        ),
        (
            lambda t: W.LocalModel(at=(0, 0, 0), normal=(1, 0, 0), stiffness=1, radius=None),
            "LocalModel.radius = None: must be a number",
        ),
        (
            lambda t: W.LocalModel.of_force((0, 0, 0), "a", 1),
            "LocalModel.of_force: force = 'a' N: must be three numbers in [-1e+09, 1e+09] N",
        ),
        (
            lambda t: W.LocalModel.of_force((0, 0, "a"), (1, 0, 0), 1),
            "LocalModel.of_force: x = (0, 0, 'a') m: must be three numbers in [-10, 10] m",
        ),
        (
            lambda t: W.LocalModel.of_force((0, 0, 0), (1, 0, 0), "a"),
            "LocalModel.of_force: stiffness = 'a': must be a number",
        ),
        (lambda t: W.force_depth(W.Elastic(), depth="a"), "depth = 'a': must be a number"),
        (
            lambda t: E.identify.Target.tapping("a", 1.0),
            "Target.tapping: frequency = 'a': must be a number",
        ),
        (
            lambda t: E.Operators.grid().scenarios(3),
            "Operators.scenarios takes a Scenario, not 3 (int)",
        ),
        (lambda t: E.explore.explore(3), "ebac.explore.explore takes a Trace, not 3 (int)"),
        (
            lambda t: E.study(E.Operators.sample(1, 1), ["ebac"], 3),
            "ebac.study takes conditions by name, not 3 (int)",
        ),
        (
            lambda t: E.testing.assert_passive(3),
            "ebac.testing.assert_passive takes a Trace, not 3 (int)",
        ),
        (lambda t: W.distance(5, [[0, 0, 0]]), f"distance: solid = 5: must be a solid: {SOLIDS}"),
        (
            lambda t: W.distance(W.Sphere(), "a"),
            "distance: points = 'a' (str): must be numbers, shape (n, 3)",
        ),
        (
            lambda t: E.gastroscope.Lumen(points=[[0, 0, 0], [0, 0, 1]], radii=[1, 1], wall=5),
            f"Lumen.wall = 5: must be a solid: {SOLIDS}",
        ),
        (
            lambda t: E.gastroscope.Lumen(5),
            "Lumen.patient takes a Patient, not 5 (int)",
        ),
        (
            lambda t: E.testing.assert_within_limits(3),
            "ebac.testing.assert_within_limits takes a Trace, not 3 (int)",
        ),
        (
            lambda t: E.testing.assert_within_limits(t, force="x"),
            "force = 'x': must be a number",
        ),
        (lambda t: E.testing.assert_passive(t, damping="x"), "damping = 'x': must be a number"),
        (
            lambda t: E.testing.compare(t, t, columns="x"),
            "columns = 'x' (str): must be a sequence, such as ['x']",
        ),
        (lambda t: E.metrics.drawn(3), "ebac.metrics.drawn takes a Trace, not 3 (int)"),
        (
            lambda t: E.metrics.work_of_surfaces(3),
            "ebac.metrics.work_of_surfaces takes a Trace, not 3 (int)",
        ),
        (
            lambda t: E.metrics.allowed_deviation(3),
            "ebac.metrics.allowed_deviation takes a Scenario, not 3 (int)",
        ),
        (lambda t: E.replay(t, "direct", scenario=3), "ebac.replay takes a Scenario, not 3 (int)"),
        (
            lambda t: E.replay(t, "direct", scenario=""),
            "ebac.replay takes a Scenario, not '' (str)",
        ),
        (lambda t: E.faults.run_campaign(1.5), "cases = 1.5: must be a whole number"),
        (lambda t: E.faults.run_case(None), "index = None: must be a whole number"),
        (lambda t: E.faults.run_case(0, seed="x"), "seed = 'x': must be a whole number"),
        (
            lambda t: E.gastroscope.Procedure(hand=3),
            "Procedure.hand = 3 (int): must be a Hand",
        ),
        (
            lambda t: E.gastroscope.Procedure(device=3),
            "Procedure.device = 3 (int): must be a Device",
        ),
        (
            lambda t: E.gastroscope.Procedure(targets=[1]),
            "Procedure.targets takes a sequence of Polyp, not 1 (int)",
        ),
        (
            lambda t: E.gastroscope.Procedure(seconds=True),
            "Procedure.seconds = True: must be a number",
        ),
        (
            lambda t: E.gastroscope.gastroscopy(procedure=3),
            "ebac.gastroscope.gastroscopy takes a Procedure, not 3 (int)",
        ),
        (lambda t: E.gastroscope.gastroscopy(every=1.5), "every = 1.5: must be a whole number"),
        (
            lambda t: E.gastroscope.gastroscopy_study(procedure=3),
            "ebac.gastroscope.gastroscopy_study takes a Procedure, not 3 (int)",
        ),
        (lambda t: E.gastroscope.camera("x", 0), "camera: bend_x = 'x': must be a number"),
        (
            lambda t: E.gastroscope.camera(0, 0, 3),
            "ebac.gastroscope.camera takes a Scope, not 3 (int)",
        ),
        (
            lambda t: E.tracking.evaluate(3),
            "ebac.tracking.evaluate takes a RecordedPath, not 3 (int)",
        ),
        (
            lambda t: E.tracking.error_budget(device=3, runs=2),
            "ebac.tracking.error_budget takes a Device, not 3 (int)",
        ),
        (
            lambda t: E.tracking.error_budget(sources=0, runs=2),
            "ebac.tracking.error_budget takes ErrorSources as its sources, not 0 (int)",
        ),
        (
            lambda t: E.tracking.error_budget(seed=[], runs=2),
            "seed = []: must be a whole number",
        ),
        (
            lambda t: E.tracking.read_path(3),
            "ebac.tracking.read_path takes the path of a file, not 3 (int)",
        ),
        (
            lambda t: E.paper.report(3, ["eq1"]),
            "ebac.paper.report takes the path of a folder, not 3 (int)",
        ),
        (
            lambda t: E.paper.report("x", "eq1"),
            "items = 'eq1' (str): must be a sequence, such as ['eq1']",
        ),
        (
            lambda t: E.datasets.write("circle", 3),
            "ebac.datasets.write takes the path of a folder, not 3 (int)",
        ),
        (lambda t: E.live.page(3), "ebac.live.page takes the path of a file, not 3 (int)"),
        (lambda t: E.plot.colour(3), "ebac.plot.colour takes the name of a law, not 3 (int)"),
        (
            lambda t: E.plot.plot_columns(t, [3]),
            "ebac.plot.plot_columns takes names of columns, not 3 (int)",
        ),
        (
            lambda t: E.plot.plot_walls([3]),
            "ebac.plot.plot_walls takes a Trace, or several, not 3 (int)",
        ),
        (
            lambda t: E.plot.plot_world(W.World(W.Plane()), [3]),
            "ebac.plot.plot_world takes traces, each a Trace, not 3 (int)",
        ),
        (
            lambda t: E.plot.plot_overlay(t, 3),
            "ebac.plot.plot_overlay takes a golden Trace, not 3 (int)",
        ),
        (lambda t: t.rows(0, 1.5), "last = 1.5: must be a whole number"),
        (
            lambda t: E.Operators.sample(2, most_pull="x"),
            "Operators.sample: most_pull = 'x': must be a number",
        ),
        (lambda t: E.realtime.measure(seconds="x"), "seconds = 'x': must be a number"),
        (
            lambda t: identify.Recording(name="r", t=None, x=np.arange(99)),
            "r: t = None (NoneType): must be an array of numbers",
        ),
    ],
)
def test_a_value_of_another_type_is_refused_by_name(
    call: Callable[[Any], object], message: str, trace: Any
) -> None:
    with pytest.raises(TypeError) as refused:
        call(trace)
    assert str(refused.value) == message


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (
            lambda t: W.Tube.along([(0, 0, 0)], 1),
            ValueError,
            "Tube.along: points: shape (1, 3): must be (n, 3), n at least 2",
        ),
        (
            lambda t: W.Tube([(0, 0, 0), (0, 0, 0.1), (0, 0, 0.2)], radius=(0.01, 0.02)),
            ValueError,
            "Tube.radius = (0.01, 0.02): shape (2,): must be one number, or one for each of the 3 points",
        ),
        *(
            (
                lambda t, x=x: W.World(W.Plane()).walk(x),
                ValueError,
                f"World.walk: x: shape {shape}: must be (n, 3)",
            )
            for x, shape in (
                ([[0, 0, 0, 1, 1, 1]], (1, 6)),
                ([[0, 0]], (1, 2)),
                ([[0, 0, 0, 0]] * 3, (3, 4)),
            )
        ),
        (
            lambda t: W.World(W.Plane()).walk([[0, 0, 0]] * 2, [[0, 0], [0, 0]]),
            ValueError,
            "World.walk: v: shape (2, 2): must be (n, 3)",
        ),
        (
            lambda t: W.World(W.Plane()).walk([[0, 0, 0]] * 2, t=[[0, 1]]),
            ValueError,
            "World.walk: t: shape (1, 2): must be (n,)",
        ),
        (
            lambda t: t.between(0, 10**400),
            ValueError,
            "stop = 1000000000...: is too large for a number",
        ),
        (
            lambda t: E.drives.Traffic(name="PDO", size=9, rate=1e3),
            ValueError,
            "PDO: size = 9 bytes: must lie in [0, 8] bytes",
        ),
        (
            lambda t: E.drives.Traffic(name="PDO", size=8, rate=float("nan")),
            ValueError,
            "PDO: rate = nan Hz: must be finite, at least 0 Hz",
        ),
        (
            lambda t: E.gastroscope.Slave(start=float("nan")),
            ValueError,
            "Slave.start = nan m: must lie in [0, 1] m",
        ),
        (
            lambda t: E.Operators(
                m_kg=np.ma.masked_array([0.1, 0.2], [0, 1]),
                b_Ns_per_m=1,
                k_N_per_m=100,
                target_m=0.02,
            ),
            ValueError,
            "row 2: m_kg is masked: leave the row out, or give its value",
        ),
        (lambda t: t.head(-3), ValueError, "rows = -3: must be at least 0"),
        (lambda t: t.rows(-3, 5), ValueError, "first = -3: must be at least 0"),
        (
            lambda t: E.testing.assert_within_limits(t, force=-1),
            ValueError,
            "force = -1: must not be negative",
        ),
        (
            lambda t: E.testing.compare(t, t, columns=[]),
            ValueError,
            "columns = []: is empty; give one at least",
        ),
        (
            lambda t: E.gastroscope.camera(float("nan"), 0),
            ValueError,
            "camera: bend_x = nan rad: must be finite",
        ),
        (
            lambda t: identify.Target.tapping(1.0, 1e300),
            ValueError,
            "Target.tapping: frequency = 1.0 Hz, seconds = 1e+300 s: must be at most 100000 periods",
        ),
        (
            lambda t: identify.Target.tapping(1.0, 1.0, float("nan")),
            ValueError,
            "Target.tapping: start = nan s: must be finite",
        ),
        (
            lambda t: E.Operators(m_kg=10**400, b_Ns_per_m=1, k_N_per_m=100, target_m=0.02),
            ValueError,
            f"row 1: m_kg = 1{'0' * 400}: must be a number in kg",
        ),
        *(
            (
                lambda t, find=find: find([1]),
                KeyError,
                f"no {kind} is called [1]{more}",
            )
            for find, kind, more in (
                (
                    E.teleop.scheme,
                    "scheme",
                    "; there are: position-force, master-passivity, two-port-passivity, waves, ebac, two-port-ebac",
                ),
                (E.paper.find, "item of the paper", "; `ebac paper --help` lists all"),
                (E.datasets.write, "data set", "; `ebac demo` lists all"),
                (
                    E.gastroscope.configuration,
                    "configuration of a gastroscope",
                    "; there are: master, feed, bend",
                ),
            )
        ),
        (
            lambda t: E.presets.hand([1]),
            KeyError,
            "no hand is called [1]; `ebac presets` lists all",
        ),
    ],
)
def test_a_value_that_cannot_be_is_refused_by_name(
    call: Callable[[Any], object], kind: type[Exception], message: str, trace: Any
) -> None:
    with pytest.raises(kind) as refused:
        call(trace)
    assert refused.value.args[0] == message


@pytest.mark.parametrize("load", [ebac.load, ebac.Scenario.load])
def test_a_file_that_is_not_there_is_told_as_the_command_says_it(
    load: Callable[[Path], object], tmp_path: Path
) -> None:
    with pytest.raises(FileNotFoundError, match=r"there is no such file: .*none\.npz"):
        load(tmp_path / "none.npz")
    folder = tmp_path / "logs.npz"
    folder.mkdir()
    with pytest.raises(IsADirectoryError, match=r"is a folder; give a file in it: .*logs\.npz"):
        load(folder)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: E.Operators.grid(mass=None), "Operators.grid: mass = None (NoneType): must be a"),
        (
            lambda: E.Operators.grid(stiffness=[100, float("nan")]),
            "row 2: k_N_per_m = nan N/m: must",
        ),
        (lambda: E.Operators.grid(most_pull=None), "Operators.grid: most_pull = None: must be a"),
        (lambda: identify.Target.following(0.1), "Target.path: shape (): must be (rows,)"),
        (lambda: identify.Target.held().late("x"), "Target.late: seconds = 'x': must be a number"),
        (lambda: E.gastroscope.Lumen().line(float("nan")), "Lumen.line: s = nan m: must be finite"),
        (
            lambda: W.HeightField([[0, 0], [0, 0.0]]).error(samples=0),
            "HeightField.error: samples = 0: must be at least 1",
        ),
    ],
)
def test_numbers_that_would_give_nonsense_are_refused(
    call: Callable[[], object], message: str
) -> None:
    with pytest.raises((TypeError, ValueError), match=re.escape(message)):
        call()


def test_results_are_asked_for_what_they_have() -> None:
    hands, short = ebac.Operators.sample(1, 1), ebac.Scenario(seconds=0.3)
    stiff = ebac.stiffest("direct", population=hands, stiffnesses=[1e3], base=short)
    with pytest.raises(KeyError, match="no criterion is called 'good_in_tiem', did you mean"):
        stiff.holds("good_in_tiem")
    found = ebac.stability_map("direct", base=short, xs=[1.0, 2.0], ys=[1e3, 2e3])
    with pytest.raises(ValueError, match="epsilon = nan J: must be at least 0"):
        found.scores(float("nan"))
    random: Any = ebac.random_worlds("direct", kinds=["planes"], devices=["2-axes"], hands=1)
    with pytest.raises(TypeError, match=r"RandomWorlds\.trace takes one of its rows, not 3"):
        random.trace(3)


def test_what_is_right_is_taken() -> None:
    assert identify.Target.steps(0.5, 1).switches == (0.5, 1)
    assert len(ebac.Operators.sample(2, 1)) == 2
    assert drives.load("joystick").nodes
    assert ebac.Variant("ebac", {"kp": 0.2}).name == "ebac, kp = 0.2"


def test_no_time_is_no_default_time() -> None:
    known = E.hardware.Configuration.from_toml("")
    with pytest.raises(ValueError, match=r"seconds = 0 s: must lie in \[0.01, 100000\] s"):
        known.simulate(seconds=0)


def test_one_condition_may_stand_without_a_list() -> None:
    rows = ebac.study(ebac.Operators.sample(1, 1), "direct", "d2K10").rows
    assert [row.condition for row in rows] == ["d2K10"]


def test_a_run_that_does_not_fit_into_memory_is_refused_with_its_rows() -> None:
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (16 << 30, before[1]))  # bytes
    try:
        with pytest.raises(MemoryError, match=r"^100,000,001 rows, of 1000 s in ticks of 1e-05 s"):
            ebac.simulate(ebac.Scenario(seconds=1e3, timing=ebac.Timing(dt=1e-5)), "direct")
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


@pytest.mark.parametrize("name", [name for name in ebac.plot.__all__ if name.startswith("plot_")])
def test_a_figure_names_what_it_draws(name: str) -> None:
    golden = {"plot_columns": (["x"],), "plot_overlay": (3,)}
    with pytest.raises(TypeError, match=rf"{name}( takes |: runs = 3 ).*3"):
        getattr(ebac.plot, name)(3, *golden.get(name, ()))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: E.ablation(changes={"guard": False}), "takes changes that are mappings, as"),
        (lambda: E.engines([]), "engines: laws = []: is empty"),
        (lambda: E.engines(rates=[]), "engines: rates = []: is empty"),
        (
            lambda: E.tune("tca-damped", ["d1K10"], ranges={"kp": 3}),
            "kp = 3 (int): must be a sequence, such as [3]",
        ),
    ],
)
def test_arguments_of_studies_are_refused_by_name(call: Callable[[], Any], message: str) -> None:
    with pytest.raises((TypeError, ValueError), match=re.escape(message)):
        call()


def test_a_configuration_that_is_none_is_refused_without_a_place_in_the_package() -> None:
    with pytest.raises(FileNotFoundError, match="no configuration has this name: 'none'"):
        ebac.datasets.joystick_text("none")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"stiffness": float("nan")}, "stiffness = nan N/m: must be finite"),
        ({"levels": [float("nan")]}, "levels = [nan] m: must be finite"),
        ({"levels": ["x"]}, "levels = 'x': must be a number"),
    ],
)
def test_a_frequency_response_is_of_finite_numbers(given: dict[str, Any], message: str) -> None:
    t = np.arange(2000) * 1e-3
    recording = identify.Recording(name="r", t=t, x=np.sin(9 * t), force=np.cos(9 * t))
    with pytest.raises((TypeError, ValueError), match=re.escape(message)):
        identify.frequency_response(recording, **given)
    with pytest.raises(TypeError, match=re.escape("fit_arm takes fixed values by name")):
        E.identify.fit_arm(recording, fixed=3)
    with pytest.raises(TypeError, match=re.escape("ask = None (NoneType): must be a sequence")):
        E.identify.check_log(recording, ask=None)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: E.Condition(name="a"), "Condition needs summary, change; it has: name, summary"),
        (lambda: E.teleop.Scheme(name="a"), "Scheme needs law, coupling, summary; it has: name"),
        (lambda: W.LocalModel(at=(0, 0, 0)), "LocalModel needs normal, stiffness; it has: at"),
        (lambda: E.gastroscope.Procedure(pedals=1), "Procedure has no parameter 'pedals'"),
        (lambda: E.gastroscope.Lumen(size=1), "Lumen has no parameter 'size'"),
        (lambda: E.studies.Measure(key="a"), "Measure needs heading"),
    ],
)
def test_a_constructor_names_what_it_takes(make: Callable[[], object], message: str) -> None:
    with pytest.raises(TypeError, match=re.escape(message)):
        make()
