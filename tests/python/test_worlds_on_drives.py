"""Worlds of bodies in a configuration: through simulated drives, and changed while the loop runs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import ebac
from ebac.hardware import Configuration, Run
from ebac.worlds import Body, Elastic, Placed, Sphere, World

#: The fixture: waits for something that happens while a loop runs.
Until = Callable[[Run, Callable[[], bool]], None]
EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"
BALL = World(Body(solid=Placed(Sphere(), (0.03, 0, 0)), material=Elastic(stiffness=5000)))


def test_a_configuration_has_a_world(tmp_path: Path) -> None:
    text = EXAMPLE.read_text(encoding="utf-8")
    start = text.index("[environment]")
    end = text.index("\n[", start)
    ball = """[environment]
type = "World"

[[environment.bodies]]
material = { type = "Elastic", stiffness = 5000.0 }
solid = { type = "Placed", at = [0.03, 0.0, 0.0], solid = { type = "Sphere", radius = 0.02 } }
"""
    file = tmp_path / "ball.toml"
    file.write_text(text[:start] + ball + text[end:], encoding="utf-8")
    known = Configuration.load(file)
    assert known.environment == BALL
    trace = known.simulate(seconds=3)
    assert trace["f_env"].any()
    assert ebac.contact(trace).rest_m > 0.01


@pytest.mark.real_time
def test_a_running_loop_takes_another_world(until: Until) -> None:
    known = Configuration.load(EXAMPLE)
    patient = known.limits.replace(overruns=100_000, pause=100, force_age=10, jump=1.0, speed=100.0)
    known = known.replace(silent=1000, limits=patient, environment=BALL)
    with ebac.Device.open(known, simulate=True) as device, device.start("ebac", seconds=30) as run:
        until(run, lambda: run.state is ebac.LoopState.RUN)
        with pytest.raises(ValueError, match="a world of bodies is changed as a whole"):
            run.change(stiffness=1000.0)
        for x in (0.030, 0.029, 0.028):
            ball = World(Placed(Sphere(), (x, 0, 0)))
            assert run.change(ball) == ball
            del ball  # the run keeps it
            seen = run.ticks
            until(run, lambda: run.ticks >= seen + 50)  # noqa: B023
        run.stop()
    assert np.isfinite(run.finish()["f_env"]).all()
