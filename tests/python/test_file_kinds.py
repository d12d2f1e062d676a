"""A file that is given to the wrong command is called what it is."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

import ebac
from ebac import datasets, drives
from ebac._util.file_kinds import CONFIGURATION, NETWORK, PROFILE, SCENARIO, kind_of
from ebac._util.toml import parsed
from ebac.cli import app
from ebac.drives.profile import builtin, read_source

FILES = {
    "scenario.toml": "[device.mechanics]\nhandle_mass = 0.2\n[hand]\nmass = 0.1\n",
    "profile.toml": read_source("generic-cia402").text,
    "network.toml": '[[node]]\nid = 1\nprofile = "profile.toml"\n',
    "run.toml": datasets.joystick_text("joystick"),
}


def test_every_file_that_comes_with_ebac_is_known_for_what_it_is() -> None:
    assert kind_of(parsed(ebac.Scenario().to_toml())) == SCENARIO
    for name in ("handle", "joystick", "joystick-3"):
        assert kind_of(parsed(datasets.joystick_text(name))) == CONFIGURATION
    for name in builtin():
        assert kind_of(parsed(read_source(name).text)) in (NETWORK, PROFILE)
    assert kind_of({}) == ""


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("wall --scenario network.toml", "this is a network file of drives, not a scenario"),
        ("wall --scenario profile.toml", "this is a profile of a drive, not a scenario"),
        ("wall --scenario run.toml", "this is a configuration of `ebac run`, not a scenario"),
        ("run profile.toml --virtual", "this is a profile of a drive; give the configuration"),
        ("run network.toml --virtual", "this is a network file"),
        ("run scenario.toml --virtual", "this is a scenario"),
        ("drive plan scenario.toml", "is a scenario, which names no drives"),
        ("drive plan run.toml", "which it names in bus.drives: joystick"),
    ],
)
def test_the_wrong_file_is_named(
    words: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).write_text(text)
    found = CliRunner().invoke(app, words.split())
    assert found.exit_code == 2
    assert message in " ".join(found.output.split())


def test_drives_that_no_bus_names_are_the_built_in_ones() -> None:
    text = "[limits]\nspeed = 1.0\n[device.motor]\ntorque_constant = 0.06\n"
    with pytest.raises(
        drives.ProfileError, match=r"The file has no \[bus\], so its drives are the"
    ):
        ebac.hardware.Configuration.from_toml(text, name="mine")
