"""What `ebac live` allows a page on hardware, and what its command refuses."""

import json
import signal
import subprocess
import sys
import urllib.request
from math import pi
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import ebac
from ebac import datasets, worlds
from ebac._core import Disc, Free, Wall
from ebac._util.surfaces import distances_at
from ebac.cli import app
from ebac.cli.catalogue.contact_at_place import met
from ebac.live import Session
from ebac.live.device_limits import DeviceLimits, surface_of
from ebac.live.surface import surface


def test_a_world_that_the_handle_stands_in_is_refused() -> None:
    limits = DeviceLimits.of(Wall(stiffness=5e3), None, None)
    limits.check_place(Wall(position=0.01, stiffness=5e3), [0.0105])
    with pytest.raises(ValueError, match="stands 10 mm inside that world: move it out"):
        limits.check_place(Wall(position=0.01, stiffness=5e3), [0.02, 0.0])
    limits.check_place(Free(), [0.02])


def test_a_body_that_swings_stands_where_it_is_at_the_time_0() -> None:
    motion = worlds.Swing(amplitude_x=0.02, phase=pi / 2)
    ball = worlds.World(worlds.Body(solid=worlds.Sphere(radius=0.02), motion=motion))
    vertices, _ = surface(ball)
    assert 0.5 * (vertices.min(axis=0) + vertices.max(axis=0)) == pytest.approx(
        [0.02, 0, 0], abs=1e-4
    )
    limits = DeviceLimits.of(ball, None, None)
    limits.check_place(ball, [-0.01])
    with pytest.raises(ValueError, match="stands 10 mm inside that world"):
        limits.check_place(ball, [0.03])
    assert distances_at(ball, [-0.01])["body 1"] == pytest.approx(0.01)
    assert met(ball, (0.03, 0.0, 0.0))["distance_m"] == pytest.approx(-0.01)


def test_limits_of_a_file_hold_for_every_kind_of_world() -> None:
    from ebac.worlds.presets import preset

    assert surface_of(Free()) == (0, 0)
    assert surface_of(Disc(stiffness=3e3, damping=2)) == (3e3, 2)
    assert surface_of(preset("box", stiffness=4e3, damping=1)) == (4e3, 1)
    assert surface_of(preset("tissue")) == (1500, 4)
    own = preset("soft")
    limits = DeviceLimits.of(own, None, None)
    limits.check(own)  # that of the file itself
    with pytest.raises(ValueError, match="stiffness = 100 N/m: this device allows 0 N/m"):
        limits.check(Wall(stiffness=100))
    declared = DeviceLimits.of(own, 2e3, 5.0)
    declared.check(preset("tissue"))
    assert declared.ranges["stiffness"] == (100, 2e3)
    with pytest.raises(ValueError, match="no number of N/m"):
        declared.check(worlds.World(*own.bodies, *preset("soft").bodies))
    with pytest.raises(ValueError, match="max_stiffness = nan N/m"):
        DeviceLimits.of(own, float("nan"), None)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--virtual", "--simulated"], "--virtual excludes --simulated"),
        (["--allow-control"], "are for hardware: give its file"),
        (["--virtual", "--max-stiffness", "1e4"], "are for hardware: give its file"),
        (
            ["joystick.toml", "--scenario", "mine.toml"],
            "--scenario mine.toml: excludes a configuration",
        ),
        (["--scenario", "mine.toml"], "mine.toml: there is no such file"),
        (["--scenario", "mine.toml", "--page", "live.html"], "--page excludes --scenario"),
        (
            ["--law", "Sfa_tuned"],
            "--law Sfa_tuned: the page has no laws with tuned parameters; give sfa",
        ),
        (["--scenario", "mine.toml", "--allow-control"], "are for hardware: give its file"),
    ],
)
def test_options_that_do_not_belong_together_are_refused(words: list[str], message: str) -> None:
    found = CliRunner().invoke(app, ["live", "--no-browser", *words])
    assert found.exit_code == 2
    assert message in " ".join(found.output.split())


@pytest.mark.parametrize(
    ("words", "remedy"),
    [(["run"], "add --simulated or --virtual"), (["live", "--no-browser"], "give --scenario")],
)
def test_a_file_with_no_table_of_drives_opens_no_bus(
    tmp_path: Path, words: list[str], remedy: str
) -> None:
    file = tmp_path / "device.toml"
    file.write_text("[device.mechanics]\ngravity = 0.0\n")
    found = CliRunner().invoke(app, [*words, str(file)])
    told = " ".join(found.output.split())
    assert found.exit_code == 2
    assert "no table of it says which bus and drives these are, such as [bus]; " + remedy in told


def test_the_command_turns_the_observer_on_and_off(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    served: list[tuple[Any, Any]] = []

    def serve(given: Any, *, observer: bool | None = None, **_: Any) -> Any:
        served.append((given, observer))
        raise OSError("in use")

    monkeypatch.setattr("ebac.live.serving.serve", serve)
    file = own_bus(tmp_path)
    text = file.read_text()
    sensor = datasets.joystick_text("joystick").partition("[sensor]")[2].partition("[recording]")[0]
    file.write_text(f"{text}\n[sensor]{sensor}")
    for words in (["--no-observer"], [str(file), "--virtual", "--observer"]):
        CliRunner().invoke(app, ["live", "--no-browser", *words])
    assert served[0] == (None, False)
    assert served[1][0].observer is True
    assert served[1][1] is None


def own_bus(folder: Path) -> Path:
    """Write a file of hardware whose bus, with drives and a hand at rest, is inside the process that opens it."""
    text = datasets.joystick_text("joystick")
    text = text.replace('interface = "socketcan"', 'interface = "ebac"')
    text = text.replace('channel = "can0"', 'channel = "joystick-live"')
    text = text.replace('setup = "verify"', 'setup = "apply"').replace(
        "[bus]\n", "[bus]\nsilent = 200\n"
    )
    before, _, rest = text.partition("[sensor]")
    file = folder / "joystick.toml"
    file.write_text(before + rest[rest.index("[recording]") :])
    return file


@pytest.mark.real_time
@pytest.mark.parametrize("words", [[], ["--allow-control"], ["--virtual"]])
@pytest.mark.slow
def test_the_command_opens_a_file_and_gives_no_power_by_itself(
    tmp_path: Path, words: list[str]
) -> None:
    pytest.importorskip("websockets")
    command = [sys.executable, "-m", "ebac.cli", "live", str(own_bus(tmp_path)), *words]
    with subprocess.Popen(
        [*command, "--no-browser", "--json"],
        cwd=tmp_path,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as run:
        assert run.stdout is not None
        url = json.loads(run.stdout.readline())["url"]
        with urllib.request.urlopen(url, timeout=5) as answer:
            assert answer.status == 200
        run.send_signal(signal.SIGINT)
        _, said = run.communicate(timeout=30)
    assert run.returncode == 0, said
    assert "drives without power. Kept: no files" in said
    assert "Traceback" not in said


def test_the_command_simulates_a_scenario(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        "seed = 4\n[environment]\nstiffness = 2500.0\n[hand]\nmass = 0.3\n[timing]\ndelay = 2\n"
    )
    served: list[Any] = []

    def serve(given: Any, **_: Any) -> Any:
        served.append(given)
        raise OSError("in use")

    monkeypatch.setattr("ebac.live.serving.serve", serve)
    found = CliRunner().invoke(app, ["live", "--no-browser", "--scenario", str(file)])
    assert "in use" in found.output
    assert "mine.toml: the page does not take seed" in " ".join(found.output.split())
    assert served == [ebac.Scenario.load(file)]
    with Session(served[0], virtual=True, folder=tmp_path) as session:
        found_scenario = session.scenario
    assert found_scenario.hand.mass == 0.3
    assert found_scenario.environment == Wall(stiffness=2500.0)
    assert found_scenario.device.mass == pytest.approx(served[0].device.mass)
    assert found_scenario.timing.delay == 2
