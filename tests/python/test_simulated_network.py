"""A user's own drives, simulated as his configuration, profile or data sheet describes them."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

import ebac
from ebac import drives
from ebac._core import DriveWiring, Joystick, LoopbackHub, LoopbackJoystick, SimulatedDrive
from ebac.can.channels import standing
from ebac.cli import app
from ebac.cli.drive import results
from ebac.drives.profile import read_source
from ebac.drives.simulate import inject
from ebac.hardware import Configuration, Signs, find_signs
from ebac.hardware.dictionary import dictionary
from ebac.hardware.wiring import wiring_of

sys.path.insert(0, str(Path(__file__).parents[1] / "sheets"))
sys.path.insert(0, str(Path(__file__).parents[1] / "buses"))
from maker_sheets import sheet
from simulated_bus import SimulatedBus

EXAMPLE = (Path(__file__).parents[2] / "examples" / "joystick.toml").read_text(encoding="utf-8")
#: Ids that are neither consecutive nor in order, and two kinds of drive, which wait for a busy machine.
NETWORK = """
[bus]
bitrate = 1_000_000
[[node]]
id = 9
name = "outer"
profile = "maxon-epos4"
sync.period = 0.05
[[node]]
id = 5
name = "inner"
profile = "elmo-gold"
sync.period = 0.05
"""


@pytest.fixture
def own(tmp_path: Path) -> Path:
    """The configuration of somebody's own drives."""
    (tmp_path / "net.toml").write_text(NETWORK, encoding="utf-8")
    file = tmp_path / "mine.toml"
    text = EXAMPLE.replace('drives = "joystick"', 'drives = "net.toml"')
    more = "[signs]\nmotor = [-1, 1]\nencoder = [1, -1]\n[zero]\ncounts = [100, -7]\n"
    file.write_text(f"{text}\n{more}", encoding="utf-8")
    return file


def command(*words: str | Path) -> Result:
    return CliRunner().invoke(app, ["drive", *map(str, words)])


def said(result: Result) -> str:
    return " ".join(result.output.split())


@pytest.mark.parametrize(
    "name", [n for n in drives.builtin() if n != "handle" and not n.startswith("joystick")]
)
def test_every_profile_goes_onto_the_drive_that_is_simulated_for_it(
    name: str, tmp_path: Path
) -> None:
    (node,) = drives.load(name, nodes=[5]).nodes
    simulated = SimulatedDrive(node=5, sheet=dictionary(node))
    with drives.DriveBus(SimulatedBus(simulated, per_frame=1e-3)) as bus:
        drive = bus.drive(5)
        drives.apply(drive, node, backups=drives.Backups(tmp_path))
        drives.verify(drive, node)
        with drive:
            drive.enable()
        for obj, _ in node.profile.absent():
            assert drive.look(obj) is None
        for one in node.profile.objects:
            assert drive.look(one.object) == one.value


@pytest.mark.parametrize(
    ("kind", "value"),
    [("u8", 0xFF), ("i8", -0x80), ("u16", 0xFFFF), ("i16", -0x8000), ("u32", 0xFFFFFFFF), ("i32", -0x80000000)],
)  # fmt: skip
def test_an_object_of_the_maker_is_as_wide_as_its_type(
    kind: str, value: int, tmp_path: Path
) -> None:
    file = tmp_path / "own.toml"
    text = read_source("generic-cia402").text
    own = f'"0x3002:1" = {{ value = {value}, type = "{kind}" }}'
    file.write_text(f"{text}\n[objects]\n{own}\n", encoding="utf-8")
    (node,) = drives.load(file, nodes=[5]).nodes
    simulated = SimulatedDrive(node=5, sheet=dictionary(node))
    with drives.DriveBus(SimulatedBus(simulated, per_frame=1e-3)) as bus:
        drives.apply(bus.drive(5), node, backups=drives.Backups(tmp_path))
        drives.verify(bus.drive(5), node)
        assert bus.drive(5).look(node.profile.objects[0].object) == value


def test_drives_have_the_ids_zero_and_signs_of_the_configuration(own: Path) -> None:
    known = Configuration.load(own)
    wiring = wiring_of(known)
    assert wiring["nodes"] == [9, 5]
    assert (wiring["zero"], wiring["motor"], wiring["encoder"]) == ([100, -7], [-1, 1], [1, -1])
    assert json.loads(json.dumps(wiring_of(known)))["nodes"] == [9, 5]
    joystick = Joystick(known.scenario(seconds=1).setup(), wiring=DriveWiring(**wiring))
    with drives.DriveBus(SimulatedBus(joystick)) as bus:
        assert bus.scan(seconds=0.2) == [5, 9]
        assert [bus.drive(node).read("position") for node in (9, 5)] == [100, -7]
        assert bus.drive(9).look((0x3001, 1)) is not None
        assert bus.drive(5).look((0x3001, 1)) is None
        assert [bus.drive(node).look("vendor_id") for node in (9, 5)] == [0xFB, 0x9A]


def test_a_simulated_drive_has_the_maker_of_its_profile_and_the_units_of_that_maker(
    tmp_path: Path,
) -> None:
    (node,) = drives.load("maxon-epos4", nodes=[5]).nodes
    simulated = SimulatedDrive(node=5, sheet=dictionary(node))
    with drives.DriveBus(SimulatedBus(simulated, per_frame=1e-3)) as bus:
        drives.apply(bus.drive(5), node, backups=drives.Backups(tmp_path))
        rows = {row["name"]: row for row in results.holdings(bus.drive(5), everything=False)}
        inject(bus.drive(5), ["over-voltage"])
        assert bus.drive(5).state is drives.State.FAULT
    assert rows["vendor_id"]["value"] == 0xFB
    assert (rows["rated_torque"]["value"], rows["rated_torque"]["unit"]) == (52993, "1e-6 N m")
    assert not [
        row for row in rows.values() if "Copley" in row["meaning"] and row["object"] > "0x2000"
    ]
    (copley,) = drives.load("copley-accelnet", nodes=[5]).nodes
    assert dictionary(copley) == []  # the simulated drive's own dictionary is enough


@pytest.mark.parametrize("given", ["true", "-1", "0x100000000", '"maxon"'])
def test_a_maker_that_is_none_is_refused(given: str, tmp_path: Path) -> None:
    file = tmp_path / "own.toml"
    text = read_source("maxon-epos4").text
    file.write_text(text.replace("vendor = 0xFB", f"vendor = {given}", 1), encoding="utf-8")
    with pytest.raises(drives.ProfileError, match=r"own\.toml, line 4: vendor = .*0xFB is maxon"):
        drives.load(file, nodes=[5])


@pytest.mark.parametrize("motor", [1, -1])
@pytest.mark.parametrize("encoder", [1, -1])
def test_a_sign_turns_current_and_counts(motor: int, encoder: int) -> None:
    """A positive torque moves a free handle towards smaller x, where the signs are 1."""
    scenario = ebac.Scenario(hand=ebac.Hand(stiffness=0), environment=ebac.Free())
    wiring = DriveWiring(motor=[motor], encoder=[encoder], zero=[50])
    joystick = Joystick(scenario.setup(), wiring=wiring)
    with drives.DriveBus(SimulatedBus(joystick)) as bus:
        drive = bus.drive(1)
        drive.enable(mode=10)
        drive.write((0x6071, 0), 300)
        joystick.elapse(0.3)
        assert joystick.truth(0).x * motor < -1e-3
        moved = drive.read("position") - 50
        assert moved * motor * encoder < -30


@pytest.mark.parametrize(
    ("wiring", "says"),
    [
        ({"nodes": [1, 1]}, r"drive\.nodes: 1 is the id of two drives"),
        ({"nodes": [1]}, r"drive\.nodes has 1 value: must have 2, one for each axis"),
        ({"motor": [1, 2]}, r"drive\.motor = 2: must be 1 or -1"),
        ({"motor": [1]}, r"drive\.motor has 1 value: must have 2, one for each axis"),
        ({"sheets": [[]]}, r"drive\.sheets has 1 value: must have 2, one for each axis"),
    ],
)
def test_a_wiring_that_cannot_be_is_refused(wiring: dict[str, object], says: str) -> None:
    setup = ebac.Scenario(device=ebac.presets.device("joystick")).setup()
    with pytest.raises(ValueError, match=says):
        Joystick(setup, wiring=DriveWiring(**wiring))  # type: ignore[arg-type]


@pytest.mark.real_time
def test_a_run_is_simulated_on_drives_of_other_makers(own: Path) -> None:
    known = Configuration.load(own)
    patient = known.limits.replace(overruns=100_000, pause=100, force_age=10, jump=1.0, speed=100.0)
    with ebac.Device.open(known.replace(silent=1000, limits=patient), simulate=True) as device:
        trace = device.run("ebac", seconds=0.3)
    assert len(trace) > 100


@pytest.mark.real_time
@pytest.mark.slow
@pytest.mark.weekly
def test_signs_are_found_on_drives_that_stand_on_a_bus_of_their_own(own: Path) -> None:
    """As with `ebac drive simulate FILE` and `ebac drive signs FILE`, without its --simulated."""
    known = Configuration.load(own)
    wiring = DriveWiring(**wiring_of(known))
    patient = known.limits.replace(overruns=100_000, pause=100, jump=1.0, speed=100.0)
    channel = f"own-{os.getpid()}"
    here = known.replace(
        interface="ebac", channel=channel, setup="apply", silent=1000, limits=patient, sensor=None,
        hand=ebac.presets.hand("resting"),
    )  # fmt: skip

    def nodes(hub: LoopbackHub) -> LoopbackJoystick:
        return LoopbackJoystick(hub, here.scenario(seconds=10).setup(), wiring=wiring)

    with standing(channel, nodes):
        rows = find_signs(here)
        assert all(row.right for row in rows), rows
    with standing(channel, nodes):
        rows = find_signs(here.replace(signs=Signs()))
    assert [(row.node, row.right) for row in rows] == [(9, False), (5, False)]


# --- a network file with data sheets ---


def test_a_run_refuses_a_drive_of_another_maker_than_its_data_sheet(own: Path) -> None:
    (own.parent / "epos4.eds").write_text(sheet("epos4"), encoding="utf-8")
    text = NETWORK.replace('"maxon-epos4"', '"maxon-epos4"\neds = "epos4.eds"')
    (own.parent / "net.toml").write_text(text, encoding="utf-8")
    known = Configuration.load(own)
    wired = wiring_of(known)
    vendor = {(0x1018, 1): 0x286}
    wired["sheets"][0] = [(*r[:7], vendor.get(r[:2], r[7]), r[8]) for r in wired["sheets"][0]]
    channel = f"other-{os.getpid()}"
    here = known.replace(interface="ebac", channel=channel, setup="apply")

    def nodes(hub: LoopbackHub) -> LoopbackJoystick:
        setup = here.scenario(seconds=10).setup()
        return LoopbackJoystick(hub, setup, wiring=DriveWiring(**wired))

    says = r"node 9 is by vendor 0x286, and .*epos4\.eds is for vendor 0xFB"
    with standing(channel, nodes), pytest.raises(drives.DriveError, match=says):
        ebac.Device.open(here)


def test_a_node_may_have_the_data_sheet_of_its_maker(tmp_path: Path) -> None:
    (tmp_path / "epos4.eds").write_text(sheet("epos4"), encoding="utf-8")
    file = tmp_path / "net.toml"
    named = NETWORK.replace('"maxon-epos4"', '"maxon-epos4"\neds = "epos4.eds"')
    file.write_text(named, encoding="utf-8")
    epos, elmo = drives.load(file).nodes
    assert epos.sheet is not None
    assert epos.sheet.vendor == 0xFB
    assert elmo.sheet is None
    assert dictionary(epos) == epos.sheet.rows(9)
    file.write_text(named.replace("maxon-epos4", "copley-accelnet"), encoding="utf-8")
    with pytest.raises(drives.ProfileError, match=r"node 9: .*epos4\.eds lacks 9 objects"):
        drives.load(file)
    for wrong, says in (("'none.eds'", "none.eds: no such file"), ("1", "must be the name of")):
        file.write_text(named.replace('"epos4.eds"', wrong), encoding="utf-8")
        with pytest.raises(drives.ProfileError, match=rf"line 8: node 9: eds.*{says}"):
            drives.load(file)


def test_a_drive_of_a_known_maker_names_its_profile(tmp_path: Path) -> None:
    found = drives.parse_eds(sheet("epos4"), name="epos4.eds")
    simulated = SimulatedDrive(node=1, sheet=found.rows(1))
    (node,) = drives.load("copley-accelnet", nodes=[1]).nodes
    with (
        drives.DriveBus(SimulatedBus(simulated)) as bus,
        pytest.raises(drives.Missing, match="ebac drive profile") as caught,
    ):
        drives.plan(bus.drive(1), node)
    assert caught.value.__notes__ == ["Its maker is maxon: see the profile maxon-epos4"]


def test_what_is_missing_is_named_by_a_drive_that_does_not_name_its_maker() -> None:
    rows = drives.parse_eds(sheet("epos4"), name="epos4.eds").rows(1)
    secret = [(*r[:2], "wo", *r[3:]) if r[:2] == (0x1018, 1) else r for r in rows]
    (node,) = drives.load("copley-accelnet", nodes=[1]).nodes
    with (
        drives.DriveBus(SimulatedBus(SimulatedDrive(node=1, sheet=secret))) as bus,
        pytest.raises(drives.Missing, match="lacks 9 objects of the profile"),
    ):
        drives.plan(bus.drive(1), node)


# --- the commands ---


def test_simulate_says_which_drives_it_understood(own: Path) -> None:
    bus = ["--interface", "virtual", "--channel", "own", "--seconds", "0.1"]
    result = command("simulate", own, *bus)
    assert result.exit_code == 0, result.output
    assert "Simulated drives, nodes 9, 5, on virtual own." in said(result)
    assert "Node 9 (outer): maxon-epos4, the objects its profile needs; 100 counts" in said(result)
    assert "Node 5 (inner): elmo-gold" in said(result)
    assert "signs 1 (motor), -1 (encoder)." in said(result)
    (own.parent / "epos4.eds").write_text(sheet("epos4"), encoding="utf-8")
    result = command("simulate", own, *bus, "--eds", own.parent / "epos4.eds", "--hand", "open")
    assert result.exit_code == 0, result.output
    assert "epos4.eds;100countsatitszero" in said(result).replace(" ", "")  # a long path is wrapped


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--first", "3"], "--first: mine.toml gives this; change it there, or leave --first out"),
        (["--zero", "1", "--zero", "2"], "--zero: mine.toml gives this"),
        (["--device", "joystick"], "--device: mine.toml gives this"),
        (["--interface", "nothing"], "--interface nothing"),
    ],
)
def test_what_the_configuration_gives_is_not_given_again(
    own: Path, words: list[str], says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(own.parent)
    result = command("simulate", "mine.toml", *words)
    assert result.exit_code == 2
    assert says in said(result)


def test_files_that_are_no_configuration_are_named(own: Path) -> None:
    result = command("simulate", own.parent / "net.toml")
    assert result.exit_code == 2
    assert "this is a network file; give the configuration of `ebac run`" in said(result)
    text = own.read_text(encoding="utf-8")
    bare = text[: text.index("[sensor]")] + text[text.index("[recording]") :]
    own.write_text(bare, encoding="utf-8")
    result = command("simulate", own, "--sensor")
    assert result.exit_code == 2
    assert "mine.toml has no table [sensor]" in said(result)


def test_a_taken_port_of_the_sensor_is_named_and_nothing_is_said_to_be_unreadable(
    own: Path,
) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        port = other.getsockname()[1]
        text = own.read_text(encoding="utf-8")
        own.write_text(text.replace("[sensor]", f"[sensor]\nport = {port}"), encoding="utf-8")
        bus = ["--interface", "virtual", "--channel", "own", "--seconds", "0.1"]
        result = command("simulate", own, *bus, "--sensor")
    assert result.exit_code == 1
    assert f"Error: UDP at 127.0.0.1:{port}: the port is taken" in said(result)


@pytest.mark.slow
@pytest.mark.real_time  # multicast drops frames that nobody takes in time
def test_the_drives_of_a_configuration_are_set_up_from_another_process(own: Path) -> None:
    pytest.importorskip("msgpack")
    bus = ["--interface", "udp_multicast", "--channel", f"239.{os.getpid() % 250}.74.201"]
    code = "from ebac.cli import app; app()"
    with subprocess.Popen(
        [sys.executable, "-c", code, "drive", "simulate", str(own), *bus, "--until-eof"],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    ) as served:  # fmt: skip
        assert served.stdout is not None
        assert served.stdin is not None
        first = served.stdout.readline()
        if "Simulated drives" not in first:
            pytest.skip(f"no multicast here: {first}")
        bus += ["--timeout", "5"]
        net, shelf = own.parent / "net.toml", own.parent / "backups"
        done = command("apply", net, "--yes", "--backup", shelf, *bus)
        assert done.exit_code == 0, done.output
        done = command("verify", net, *bus)
        assert done.exit_code == 0, done.output
        served.stdin.close()
        assert served.wait(20) == 0


def test_profiles_are_listed_and_printed(tmp_path: Path) -> None:
    rows = json.loads(command("profile", "--json").stdout)["rows"]
    assert [row["name"] for row in rows] == drives.builtin()
    assert {row["kind"] for row in rows} == {"profile", "network file"}
    assert "maxon EPOS4" in said(command("profile"))
    file = tmp_path / "own.toml"
    file.write_text(command("profile", "maxon-epos4").stdout, encoding="utf-8")
    (same,) = drives.load("maxon-epos4", nodes=[1]).nodes
    (node,) = drives.load(file, nodes=[1]).nodes
    assert node.profile.values == same.profile.values
    result = command("profile", "maxon-epos5")
    assert result.exit_code == 2
    assert "did you mean" in said(result)
    assert "maxon-epos4" in said(result)


def test_the_wiring_of_a_run_reaches_drives_in_another_process(own: Path) -> None:
    """`ebac run --simulated` on a virtual CAN interface writes it for `ebac drive simulate`."""
    file = own.parent / "wiring.json"
    wiring = wiring_of(Configuration.load(own))
    file.write_text(json.dumps(wiring), encoding="utf-8")
    bus = ["--interface", "virtual", "--channel", "wired", "--seconds", "0.1"]
    result = command("simulate", *bus, "--wiring", file)
    assert result.exit_code == 0, result.output
    assert "Simulated drives, nodes 9, 5, on" in said(result)
    file.write_text("[1]", encoding="utf-8")
    result = command("simulate", *bus, "--wiring", file)
    assert result.exit_code == 2
    assert "is no file that `ebac run` wrote" in said(result)
