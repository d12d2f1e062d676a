"""Engines of others: a Python function as a world, the bridge in simulated time and in a thread."""

from __future__ import annotations

import pickle
import time
import warnings
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebac
from ebac import Scenario, worlds
from ebac.hardware import Configuration, Run
from ebac.worlds import (
    Body,
    Bridge,
    BridgeParams,
    Elastic,
    EngineThread,
    EngineTiming,
    FunctionWorld,
    LocalModel,
    Plane,
    Touch,
    World,
    preset,
)

WALL = preset("plane", stiffness=5e3, position=0.01)
SHORT = Scenario(environment=WALL, seconds=1.0)


def spring(x: np.ndarray, v: np.ndarray) -> list[float] | None:
    """A wall at 10 mm."""
    return [5e3 * (x[0] - 0.01), 0.0, 0.0] if x[0] > 0.01 else None


def plane(x: np.ndarray, v: np.ndarray) -> LocalModel:
    """The same wall as an engine tells it."""
    return LocalModel(at=(0.01, 0, 0), normal=(1, 0, 0), stiffness=5e3)


@pytest.mark.parametrize(
    "world", [FunctionWorld(spring), Bridge(plane, timing=EngineTiming(rate=1000))]
)
def test_a_function_is_the_wall_that_it_computes(world: worlds.FunctionWorld | Bridge) -> None:
    wall = ebac.Wall(stiffness=5e3, position=0.01)
    expected = ebac.simulate(SHORT.replace(environment=wall), "ebac")
    trace = ebac.simulate(SHORT.replace(environment=world), "ebac")
    assert np.allclose(trace["x"], expected["x"], atol=1e-12)
    assert np.allclose(trace["f_env"], expected["f_env"], atol=1e-9)
    assert ebac.contact(trace).swing_m == pytest.approx(ebac.contact(expected).swing_m, abs=1e-12)


@pytest.mark.parametrize(
    ("world", "known"),
    [
        (FunctionWorld(spring), False),
        (Bridge(plane, timing=EngineTiming(rate=1000)), False),
        (Bridge(WALL, timing=EngineTiming(rate=1000)), True),
    ],
)
def test_what_a_function_stores_is_not_known(world: FunctionWorld | Bridge, known: bool) -> None:
    scenario = SHORT.replace(environment=world)
    met = ebac.contact(ebac.simulate(scenario, "ebac"))
    assert (met.most_drawn_J is not None) == known
    assert ("drawn in any window -" in str(met)) != known
    assert np.isfinite(ebac.sweep([scenario], "ebac")["most_drawn_J"][0]) == known


def until(moving: float) -> Bridge:
    """Return a wall that an engine moves out by 1 mm/s until then [s]."""
    ticks = count()

    def wall(x: Any, v: Any) -> LocalModel:
        t = next(ticks) / 60
        at, speed = 0.01 - 1e-3 * min(t, moving), -1e-3 * (t < moving)
        return LocalModel(at=(at, 0, 0), normal=(1, 0, 0), stiffness=1e3, velocity=(speed, 0, 0))

    return Bridge(wall, timing=EngineTiming(rate=60))


def test_rest_is_not_judged_where_an_engine_reports_a_surface_that_moves(tmp_path: Path) -> None:
    """The breathing of `ebac demo engine` was called a swing of the handle."""
    for moving, judged, axes in ((9.0, False, 1), (0.3, True, 1), (9.0, False, 2)):
        device = ebac.Device(kinematics=ebac.Linear(axes=axes))
        scenario = ebac.Scenario(device=device, environment=until(moving), seconds=2)
        trace = ebac.simulate(scenario, "ebac")
        with pytest.warns(UserWarning, match="scenario"):
            trace.save(tmp_path / "run.npz")
        for run in (trace, ebac.load(tmp_path / "run.npz")):
            found = ebac.contact(run)
            assert found.surface_moves is not judged
            assert (found.verdict == "not judged: the surface moves") is not judged
            assert found.row()["verdict"] == found.verdict
    wall = ebac.Wall(motion_amplitude=1e-3, motion_frequency=1.0)
    trace = ebac.simulate(ebac.Scenario(environment=wall, seconds=1), "ebac")
    assert not ebac.contact(trace).surface_moves  # what it does is known


def test_a_touch_has_a_normal_of_its_own() -> None:
    def rough(x: np.ndarray, v: np.ndarray) -> Touch | None:
        depth = x[0] - 0.01
        if depth <= 0:
            return None
        return Touch(np.array([1e3 * depth, 0.1, 0]), np.array([2.0, 0, 0]), depth, 1e3, 0.0)

    trace = ebac.simulate(SHORT.replace(environment=FunctionWorld(rough)), "direct")
    assert trace["f_env"].max() > 1


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda bad: FunctionWorld(bad), "the world test_an_error"),
        (lambda bad: Bridge(bad), "the engine test_an_error"),
    ],
)
def test_an_error_ends_the_run_and_is_named(make, says: str) -> None:
    def bad(x: np.ndarray, v: np.ndarray) -> None:
        raise KeyError("no such tissue")

    with pytest.raises(ebac.LoopFault, match="raised KeyError: 'no such tissue'") as caught:
        ebac.simulate(SHORT.replace(environment=make(bad)), "ebac")
    assert isinstance(caught.value.__cause__, KeyError)
    assert says in str(caught.value)
    assert caught.value.fault == ebac.Fault.ENVIRONMENT_NOT_FINITE
    assert caught.value.trace["f_cmd"][-1] == 0


@pytest.mark.parametrize(
    ("answer", "says"),
    [("much", "could not convert|must return the force"), ([1.0, 2.0], "three finite"), ([np.nan, 0, 0], "finite")],
)  # fmt: skip
def test_a_world_that_answers_nonsense_says_what_it_should(answer: object, says: str) -> None:
    world = FunctionWorld(lambda x, v: answer)
    with pytest.raises(ebac.LoopFault, match=says):
        ebac.simulate(SHORT.replace(environment=world), "direct")


def test_an_engine_that_answers_no_model_says_what_it_should() -> None:
    with pytest.raises(ebac.LoopFault, match="must return a LocalModel, or None"):
        ebac.simulate(SHORT.replace(environment=Bridge(lambda x, v: 3.0)), "direct")


def test_what_is_given_wrongly_is_refused() -> None:
    with pytest.raises(TypeError, match="must be a function of position and velocity"):
        Bridge(3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="function of position and velocity"):
        FunctionWorld(None)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="62 answers"):
        Bridge(WALL, timing=EngineTiming(rate=1000, jitter=1))
    with pytest.raises(ValueError, match=r"stiffness = -1 N/m: must lie in \[0, 1e\+07\] N/m"):
        LocalModel(at=(0, 0, 0), normal=(1, 0, 0), stiffness=-1)
    with pytest.raises(ValueError, match="must have a length"):
        LocalModel(at=(0, 0, 0), normal=(0, 0, 0), stiffness=1)
    with pytest.raises(ValueError, match="radius"):
        LocalModel(at=(0, 0, 0), normal=(1, 0, 0), stiffness=1, radius=0)
    with pytest.raises(ValueError, match="rate"):
        EngineThread(plane, rate=5000)


def test_a_model_of_a_force_gives_that_force() -> None:
    assert LocalModel.of_force((0, 0, 0), (0, 0, 0), 100) is None
    model = LocalModel.of_force((0.02, 0, 0), (3, 0, 4), 1000)
    assert model is not None
    assert model.normal == pytest.approx((0.6, 0, 0.8))
    depth = np.dot(np.array([0.02, 0, 0]) - model.at, model.normal)
    assert 1000 * depth == pytest.approx(5)


def test_a_bridge_to_bodies_goes_through_toml_and_pickle() -> None:
    bridge = Bridge(
        WALL, timing=EngineTiming(rate=30, jitter=0.01), rendering=BridgeParams(blend=0.05)
    )
    scenario = SHORT.replace(environment=bridge)
    assert Scenario.from_toml(scenario.to_toml()) == scenario
    assert pickle.loads(pickle.dumps(bridge)) == bridge
    for own in (Bridge(plane), FunctionWorld(spring)):
        with pytest.raises(ValueError, match="cannot be written to TOML"):
            SHORT.replace(environment=own).to_toml()


def test_an_engine_that_falls_silent_fades_and_the_run_says_so() -> None:
    class Dies:
        def __init__(self) -> None:
            self.calls = 0

        def __call__(self, x: np.ndarray, v: np.ndarray) -> LocalModel:
            self.calls += 1
            return plane(x, v)

    bridge = Bridge(
        Dies(), timing=EngineTiming(rate=1), rendering=BridgeParams(stale=0.1, fade=0.05)
    )
    with pytest.warns(UserWarning, match=r"older than 100 ms .*its force was faded or zero"):
        trace = ebac.simulate(SHORT.replace(environment=bridge), "direct")
    asked = trace["f_env"][(trace["t"] > 0.16) & (trace["t"] < 0.99)]
    assert (asked == 0).all()
    assert bridge.report.faded_at_s == pytest.approx(0.101, abs=2e-3)
    assert bridge.engine.calls == 0  # type: ignore[union-attr]  # each run has a copy


def test_the_same_seed_gives_the_same_bits() -> None:
    bridge = Bridge(preset("sphere"), timing=EngineTiming(rate=60, jitter=0.01))
    one, other = (ebac.simulate(SHORT.replace(environment=bridge), "ebac") for _ in range(2))
    assert (one["x"] == other["x"]).all()
    later = Bridge(preset("sphere"), timing=EngineTiming(rate=60, jitter=0.01, seed=2))
    moved = ebac.simulate(SHORT.replace(environment=later), "ebac")
    assert (moved["x"] != one["x"]).any()


@given(
    seed=st.integers(0, 2**31),
    rate=st.floats(30, 1000),
    jitter=st.floats(0, 0.03),
    blend=st.floats(2e-3, 0.2),
    slew=st.floats(0.01, 1),
)
@settings(max_examples=25, deadline=None)
@pytest.mark.slow
@pytest.mark.weekly
def test_a_bridge_gives_no_more_than_it_counts(
    seed: int, rate: float, jitter: float, blend: float, slew: float
) -> None:
    random = np.random.default_rng(seed)

    def restless(x: np.ndarray, v: np.ndarray) -> LocalModel | None:
        if random.random() < 0.1:
            return None
        a, b, c = random.normal(size=3)
        return LocalModel(
            at=(2e-3 * a, 0, 0), normal=(1, 0.4 * b, 0.4 * c), stiffness=random.uniform(100, 3000)
        )

    bridge = Bridge(
        restless,
        timing=EngineTiming(rate=rate, jitter=jitter, seed=seed),
        rendering=BridgeParams(blend=blend, slew=slew),
    )
    phase = np.cumsum(random.uniform(0, 0.06, 1500))
    path = np.column_stack([4e-3 * np.sin(phase), 2e-3 * np.sin(0.7 * phase), 0 * phase])
    work, leak, force = 0.0, 0.0, np.zeros(3)
    for i, x in enumerate(path):
        way = x - path[i - 1] if i else np.zeros(3)
        work += float(force @ way)
        leak += 0.5 * 3000 * float(way @ way)
        force = bridge.contact(x, np.zeros(3), 1e-3 * i)[0]
        assert work >= -bridge.report.given_J - leak - 1e-12


def test_an_engine_in_a_thread_serves_a_loop_that_never_waits() -> None:
    inside, still = np.array([0.011, 0, 0]), np.zeros(3)
    with EngineThread(plane, rate=500, rendering=BridgeParams(stale=10.0)) as thread:
        force, tick = 0.0, 0
        while (thread.world.report.models < 20 or abs(force - 5) > 1e-3) and tick < 20_000:
            tick += 1
            force = float(thread.world.contact(inside, still, 1e-3 * tick)[0][0])
            time.sleep(1e-3)
    assert force == pytest.approx(5.0, abs=1e-3)
    assert thread.world.report.models >= 20
    assert thread.error is None


def test_an_engine_that_raises_in_its_thread_says_so_in_the_end() -> None:
    def bad(x: np.ndarray, v: np.ndarray) -> None:
        raise RuntimeError("engine down")

    thread = EngineThread(bad, rate=1000)

    def until_it_fails() -> None:
        with thread:
            while thread.error is None:
                thread.world.contact(np.zeros(3), np.zeros(3), time.monotonic())
                time.sleep(1e-3)

    with pytest.raises(worlds.EngineError) as caught:
        until_it_fails()
    said = str(caught.value)
    assert said.startswith("the engine test_an_engine_that_raises_in_its_thread_says_so_in_the_end")
    assert "bad raised RuntimeError: engine down; its thread ended there" in said
    assert caught.value.__cause__ is thread.error
    assert str(pickle.loads(pickle.dumps(worlds.EngineError(plane, RuntimeError("x"))))).startswith(
        "the engine plane raised RuntimeError: x"
    )


def test_held_forces_are_not_exact_where_models_are() -> None:
    """They shake, or the account holds them back."""
    wall = preset("plane", stiffness=10e3, position=0.01)
    timing = EngineTiming(rate=60, jitter=0.01, compute=1 / 60)
    found = {}
    for held in (True, False):
        world = Bridge(wall, timing=timing, held=held)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            trace = ebac.simulate(Scenario(environment=world, seconds=3), "ebac")
        found[held] = ebac.contact(trace)
    assert found[False].quiet
    assert found[False].exact
    assert found[False].least_energy_J > -1e-6
    assert not found[True].exact


@pytest.mark.real_time
def test_a_loop_in_real_time_takes_an_engine_in_a_thread_and_no_function(
    until: Callable[[Run, Callable[[], bool]], None], tmp_path: Path
) -> None:
    known = Configuration.load(Path(__file__).parents[2] / "examples" / "joystick.toml")
    patient = known.limits.replace(overruns=100_000, pause=100, force_age=10, jump=1.0, speed=100.0)
    known = known.replace(silent=1000, limits=patient)
    for slow in (FunctionWorld(spring), Bridge(plane)):
        with pytest.raises(ValueError, match=r"calls Python in a tick.*EngineThread"):
            known.replace(environment=slow)
    gentle = BridgeParams(stale=10.0)
    with (
        EngineThread(plane, rate=60, rendering=gentle) as thread,
        ebac.Device.open(known, simulate=True) as device,
        device.start("ebac", thread.world, seconds=30, log=tmp_path / "run.mcap") as run,
    ):
        until(run, lambda: run.state is ebac.LoopState.RUN)
        until(run, lambda: bool((run.trace()["f_env"] != 0).any()))
        run.stop()
    assert thread.world.report.models > 0
    assert np.isfinite(run.finish()["f_env"]).all()
    assert len(ebac.load(tmp_path / "run.mcap")) > 0


def test_damping_of_elastic_bodies_behind_a_bridge_is_refused_however_it_is_made() -> None:
    damped = World(Body(solid=Plane(), material=Elastic(stiffness=5e3, damping=30)))
    words = r"damping = 30 N s/m: must be 0 N s/m behind an engine"
    with pytest.raises(ValueError, match=words):
        Bridge(damped)
    text = Scenario(environment=Bridge(WALL)).to_toml()
    table = 'type = "Elastic"\nstiffness = 5000.0\ndamping = '
    assert f"{table}0.0" in text
    with pytest.raises(ValueError, match=words):
        Scenario.from_toml(text.replace(f"{table}0.0", f"{table}30.0"))
