"""`ebac drive` on the simulated drives: tables, JSON, refusals, exit codes."""

import errno
import gc
import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import can
import pytest
from typer.testing import CliRunner

from ebac import drives
from ebac._core import Joystick
from ebac.can.channels import resting_joystick
from ebac.cli import app
from ebac.drives import bus as bus_module
from ebac.drives.simulate import Simulation, refuse_taken

EXAMPLES = Path(__file__).parents[2] / "examples"
Run = Callable[..., Any]
CHANGE = ["node", "object", "name", "now", "wanted", "unit", "why"]
COMMANDS = (
    "scan", "show", "plan", "apply", "verify", "restore", "enable", "disable", "reset-fault", "simulate"
)  # fmt: skip


@pytest.fixture
def drive(
    open_bus: Callable[[], can.BusABC], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Run:
    """Run `ebac drive ...` on a bus with the simulated drives."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("COLUMNS", "160")
    monkeypatch.setattr(bus_module, "open_bus", lambda **given: open_bus())

    def run(*words: str, code: int = 0) -> Any:
        result = CliRunner().invoke(app, ["drive", *words])
        assert result.exit_code == code, result.output
        assert result.exception is None or isinstance(result.exception, SystemExit)
        return json.loads(result.stdout) if "--json" in words and code == 0 else result

    return run


def said(result: Any) -> str:
    return " ".join(re.sub(r"[│╭╮╰╯─]", " ", result.output).split())


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("peak_torque = 0.212", "peak_torque = 0.3",
         "node 1 of mine.toml: motor.peak_torque = 0.3 N m: 5.66 times limits.rated_torque = 0.053 N m; usual are "
         "at most 5 times"),
        ("max_torque = 0.212", "max_torque = 0.25",
         "node 1 of mine.toml: limits.max_torque = 0.25 N m, more than the peak of the motor, 0.212 N m "
         "(motor.peak_torque): the drive does not protect this motor; give at most 0.212 in the profile, or a higher "
         "motor.peak_torque where the motor takes more"),
        ("max_current = 3.94", "max_current = 4.5",
         "node 1 of mine.toml: limits.max_current = 4.5 A, more than the peak of the motor, 3.94 A "),
        ("event = 0.005", "event = 5",
         "node 1 of mine.toml: pdo.rpdo1.event = 5 s: for so long the drive waits for the next one from the loop; "
         "usual are at most 0.1 s. The key is in s: 5 ms is 0.005 s."),
    ],
)  # fmt: skip
def test_plan_notes_what_of_a_profile_is_likely_not_meant(
    drive: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, old: str, new: str, message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    text = drive("profile", "copley-accelnet").stdout
    Path("mine.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    noted = drive("plan", "mine.toml", "--node", "1")
    assert f"Note: {message}" in " ".join(noted.stderr.split())
    assert "Note:" not in drive("plan", "joystick").stderr


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_teaches_by_an_example(command: str) -> None:
    text = CliRunner().invoke(app, ["drive", command, "--help"]).output
    assert f"ebac drive {command}" in text
    assert "--interface" in text


def test_help_gives_the_order_of_things() -> None:
    text = CliRunner().invoke(app, ["drive", "--help"]).output
    places = [text.index(f"ebac drive {command}") for command in ("scan", "plan", "apply")]
    assert places == sorted(places)


def test_what_is_injected_is_one_document(drive: Run) -> None:
    rows = drive("inject", "over-voltage", "--node", "2", "--json")["rows"]
    assert rows == [{"node": 2, "faults": ["over-voltage"]}]
    assert drive("inject", "--node", "2", "--json")["rows"] == [{"node": 2, "faults": []}]


def test_scan_and_show(drive: Run) -> None:
    rows = drive("scan", "--timeout", "0.1", "--json")["rows"]
    assert [row["node"] for row in rows] == [1, 2]
    assert list(rows[0]) == [
        "node", "nmt", "name", "vendor_id", "product_code", "revision", "serial_number", "state", "latched",
    ]  # fmt: skip
    assert rows[0]["state"] == "switch on disabled"
    assert "switch on disabled" in drive("scan", "--timeout", "0.1").stdout
    objects = {row["name"]: row for row in drive("show", "-n", "2", "--json")["rows"]}
    assert objects["rated_torque"]["value"] == 53
    assert objects["rated_torque"]["unit"] == "mN m"
    assert list(objects["rated_torque"]) == [
        "node",
        "object",
        "name",
        "value",
        "unit",
        "meaning",
        "text",
    ]
    assert "tpdo1_cob_id" not in objects
    assert "tpdo1_cob_id" in drive("show", "-n", "1", "--all").stdout


@pytest.mark.parametrize(
    ("vendor", "torque", "velocity"),
    [
        (0, "mN m", "0.1 counts/s"),  # simulated
        (0xAB, "mN m", "0.1 counts/s"),  # Copley
        (0xFB, "1e-6 N m", "raw units"),  # maxon EPOS4, whose unit of velocity can be set
        (0x286, "mN m", "raw units"),  # Trinamic
    ],
)
def test_show_has_the_units_of_the_maker(
    drive: Run, monkeypatch: pytest.MonkeyPatch, vendor: int, torque: str, velocity: str
) -> None:
    real = drives.Drive.look

    def look(self: drives.Drive, obj: Any) -> Any:
        return vendor if getattr(obj, "name", obj) == "vendor_id" else real(self, obj)

    monkeypatch.setattr(drives.Drive, "look", look)
    objects = {row["name"]: row for row in drive("show", "-n", "2", "--json")["rows"]}
    assert objects["rated_torque"]["unit"] == torque
    assert objects["rated_current"]["unit"] == "mA"
    assert objects["velocity"]["unit"] == velocity


@pytest.mark.parametrize("width", [60, 80, 100, 160])
def test_show_crops_nothing_and_decodes_bits(
    drive: Run, monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    real = drives.Drive.look

    def look(self: drives.Drive, obj: Any) -> Any:
        names = {"latched_faults": 0x8, "error_register": 0x9, "error_code": 0x4210}
        name = obj if isinstance(obj, str) else obj.name
        return names.get(name, real(self, obj))

    monkeypatch.setattr(drives.Drive, "look", look)
    rows = drive("show", "-n", "1", "--json")["rows"]
    shown = drive("show", "-n", "1").stdout
    assert max(map(len, shown.splitlines())) <= width
    words = set(shown.split())
    for row in rows:
        missing = {
            word for key in ("name", "text", "unit", "meaning") for word in row[key].split()
        } - words
        assert not missing, row
    texts = {row["name"]: row["text"] for row in rows}
    assert texts["latched_faults"].startswith("0x8: drive over temperature (let it cool")
    assert texts["error_register"] == "0x9: generic; temperature"
    assert texts["error_code"] == "0x4210: drive over temperature"
    assert texts["supported_modes"] == "0x208: torque; cyclic torque"


def test_plan_apply_verify_restore(drive: Run, tmp_path: Path) -> None:
    planned = drive("plan", "joystick", "--json")
    assert list(planned["rows"][0]) == CHANGE
    assert planned["bus_load_share"] == pytest.approx(0.52, abs=0.005)
    assert planned["bitrate_bit_per_s"] == 1_000_000
    table = drive("plan").stdout
    for words in ("sync_period", "us", "the loop's SYNC", "position (32 bit)", "Bus load 52 %"):
        assert words in table
    assert all(
        "1, 2" in line for line in table.splitlines() if "sync_period" in line
    )  # a line for both
    assert "Not verified" in drive("verify", code=1).stdout

    applied = drive("apply", "--yes", "--json")
    assert applied["rows"] == planned["rows"]
    assert [node["node"] for node in applied["nodes"]] == [1, 2]
    assert all(Path(node["backup"]).is_file() for node in applied["nodes"])
    assert all(Path(node["backup"]).is_relative_to(tmp_path) for node in applied["nodes"])
    assert "Verified: the drives hold the built-in joystick." in drive("verify").stdout
    assert drive("verify", "--json")["rows"] == []
    assert "nothing was written" in drive("apply", "--yes").stdout

    back = drive("restore", "--yes", "--json")
    assert {row["name"] for row in back["rows"]} >= {"sync_period", "tpdo1_count"}
    assert not any(Path(node["backup"]).exists() for node in applied["nodes"])
    assert drive("plan", "--json")["rows"] == planned["rows"]
    assert "nothing to restore" in said(drive("restore", "--yes", code=1))


def test_apply_says_why_it_writes_more_than_was_planned(drive: Run) -> None:
    planned = drive("plan", "-n", "1", "--json")["rows"]
    told = " ".join(drive("apply", "-n", "1", "--yes").stdout.split())
    assert (
        f"Node 1: {len(planned)} objects in 20 writes (a PDO that changes is switched off" in told
    )


@pytest.mark.parametrize("width", [70, 80, 200])
def test_a_unit_stands_beside_its_number(
    drive: Run, monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    (line, *_) = [x for x in drive("plan").stdout.splitlines() if "sync_period" in x]
    assert "1000 us" in line


def test_one_node_of_a_network_and_a_profile_of_ones_own(drive: Run, tmp_path: Path) -> None:
    assert {row["node"] for row in drive("plan", "-n", "2", "--json")["rows"]} == {2}
    mine = tmp_path / "mine.toml"
    mine.write_text(
        "[limits]\nrated_torque = 0.053\nmax_torque = 0.1\n[heartbeat]\nconsumer = 0.3\n",
        encoding="utf-8",
    )
    names = {row["name"] for row in drive("plan", str(mine), "-n", "1", "--json")["rows"]}
    assert "max_torque" in names
    assert "is a profile for any node: a configuration" in said(drive("plan", str(mine), code=2))
    mine.write_text("[limits]\nrated_torque = -1\n", encoding="utf-8")
    message = said(drive("plan", str(mine), "-n", "1", code=2))
    assert "line 2: limits.rated_torque = -1 N m: must lie in [0.001, 1000] N m" in message


@pytest.mark.parametrize("command", ["plan", "verify", "apply", "timing"])
def test_a_configuration_of_a_run_is_not_taken_for_a_network_file(
    drive: Run, tmp_path: Path, command: str
) -> None:
    (tmp_path / "net.toml").write_text("[[node]]\nid = 1\nprofile = 'joystick'\n", encoding="utf-8")
    example = (EXAMPLES / "joystick.toml").read_text(encoding="utf-8")
    mine = tmp_path / "my-joystick.toml"
    for names, text in [
        ("joystick", example),
        (str(tmp_path / "net.toml"), example.replace('"joystick"', '"net.toml"')),
    ]:
        mine.write_text(text, encoding="utf-8")
        message = said(drive(command, str(mine), code=2)).replace(" ", "")
        wanted = (
            f"{mine}: is a configuration of `ebac run`; give the network file or profile of its drives, "
            f"which it names in bus.drives: {names}"
        )
        assert message.endswith(wanted.replace(" ", "")), message


def test_the_keys_of_timing_have_their_units(drive: Run) -> None:
    (row,) = drive("timing", "joystick", "--ticks", "20", "--json")["rows"]
    assert {key for key, value in row.items() if isinstance(value, float)} == {
        *("dt_s", "answer_s", "mean_s", "worst_s", "load_share")
    }
    assert row["bitrate_bit_per_s"] == 1_000_000


def test_apply_asks_only_what_it_does(drive: Run) -> None:
    assert "Disable node 1 and write this?" in said(drive("apply", "-n", "1", code=2))
    drive("apply", "-n", "1", "--yes")
    assert "holds all of it already, nothing was written" in said(drive("apply", "-n", "1"))
    assert "Disable node 1 and store what is held?" in said(
        drive("apply", "-n", "1", "--store", code=2)
    )
    drive("enable", "-n", "1", "--yes")
    assert "Disable node 1? Nothing is written." in said(drive("apply", "-n", "1", code=2))


@pytest.mark.parametrize("command", ["apply", "restore", "enable"])
def test_what_writes_asks_and_where_nobody_can_answer_refuses(drive: Run, command: str) -> None:
    if command != "apply":  # it asks only where it changes something
        drive("apply", "-n", "1", "--yes")
    assert "Nobody is here to ask: add --yes" in said(drive(command, "-n", "1", code=2))
    assert {row["state"] for row in drive("scan", "--json", "--timeout", "0.1")["rows"]} == {
        "switch on disabled"
    }


def test_enable_warns_powers_at_zero_torque_and_disable_ends_it(drive: Run) -> None:
    assert "zero torque cannot be promised" in said(drive("enable", "-n", "1", "--yes", code=1))
    drive("apply", "--yes")
    assert "will be powered, at zero torque" in said(drive("enable", "-n", "1", code=2))
    rows = drive("enable", "-n", "1", "-n", "2", "--yes", "--json")["rows"]
    assert rows == [{"node": n, "state": "operation enabled"} for n in (1, 2)]
    shown = {row["name"]: row["value"] for row in drive("show", "-n", "1", "--json")["rows"]}
    assert (shown["target_torque"], shown["mode_display"]) == (0, 10)
    rows = drive("disable", "--timeout", "0.1", "--json")["rows"]
    assert rows == [{"node": n, "state": "switch on disabled"} for n in (1, 2)]


@pytest.mark.slow
def test_one_drive_in_fault_leaves_none_powered(
    drive: Run, open_bus: Callable[[], can.BusABC]
) -> None:
    drive("apply", "--yes")
    with drives.DriveBus(open_bus()) as bus:
        conditions = drives.Object(name="conditions", index=0x5F00, kind="u8")
        bus.drive(2).sdo.download(conditions, b"\x01")
        message = said(drive("enable", "-n", "1", "-n", "2", "--yes", code=1))
        assert "node 2 is in fault" in message
        assert "over voltage" in message
        assert not bus.drive(1).state.powered
        assert "node 2 is in fault while resetting" in said(drive("reset-fault", "-n", "2", code=1))
        bus.drive(2).sdo.download(conditions, b"\x00")
        rows = drive("reset-fault", "-n", "2", "--json")["rows"]
        assert rows == [{"node": 2, "state": "switch on disabled"}]


def test_a_node_that_is_not_there_says_what_to_check(drive: Run) -> None:
    message = said(drive("show", "-n", "9", "--timeout", "0.02", code=1))
    assert "node 9 did not answer" in message
    assert "Check: 1." in message


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["scan", "--interface", "ebac", "--channel", "joystik"],
         "--channel: the bus 'joystik' inside this process: no such name, did you mean 'joystick'; there are:"),
        (["show", "-n", "1", "--interface", "ebac", "--channel", "joystik"], "did you mean 'joystick'"),
        (["scan", "--interface", "socketcan", "--channel", "nocan7"], "interface socketcan, channel nocan7"),
        (["scan", "--interface", "nonsense"], "--interface nonsense: no such name"),
        (["scan", "--interface", "virtual", "--channel", "empty", "--timeout", "0.01"], "Nobody answers"),
        (["disable", "--interface", "virtual", "--channel", "empty", "--timeout", "0.01"], "no drive answers"),
        (["simulate", "--channel", "nocan7"], "CAN interface 'nocan7'"),
        (["simulate", "--device", "joistick"], "no device is called 'joistick'"),
        (["plan", "joistick"], "there is no such file, and no profile of that name"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_told_in_one_sentence(words: list[str], message: str) -> None:
    result = CliRunner().invoke(app, ["drive", *words])
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    assert message in said(result)
    assert "Traceback" not in result.output


def test_a_profile_for_a_motor_needs_its_name_and_a_file_of_a_device(
    drive: Run, tmp_path: Path
) -> None:
    file = tmp_path / "device.toml"
    file.write_text(
        "[device]\npreset = 'reference'\n[device.motor]\ntorque_constant = 0.0255\nrated_torque = 0.03\n"
        "[device.encoder]\ncounts_per_turn = 2000\n"
    )
    made = drive("profile", "elmo-gold", "--motor", str(file), "--json")
    (row,) = made["rows"]
    assert row["about"].endswith("with the motor of device.toml")
    assert "max_current = 4.704" in row["text"]
    unnamed = drive("profile", "--motor", str(file), code=2)
    assert "give the NAME of the profile" in " ".join(unnamed.stderr.split())
    file.write_text("[device.motor]\ntorque_constant = 25.5\n")
    wrong = drive("profile", "joystick", "--motor", str(file), code=2)
    assert "limits.rated_current = 0.002 A" in " ".join(wrong.stderr.split())


def test_simulate_serves_until_its_time_is_over() -> None:
    words = ["drive", "simulate", "--interface", "virtual", "--channel", "sim", "--seconds", "0.2"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    assert "Simulated drives, nodes 1, 2, on" in said(result)
    assert "Stopped: 0 frames received, 2 sent." in said(result)  # boot-up of both


def test_simulate_without_can_in_the_kernel_names_a_bus_that_it_takes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Not the interface `ebac`, which this command refuses."""

    def no_can(*_given: Any, **_more: Any) -> None:
        raise OSError(errno.EAFNOSUPPORT, "there is the loopback bus: can.Bus(interface='ebac')")

    monkeypatch.setattr("ebac._core.SocketCanJoystick", no_can)
    result = CliRunner().invoke(app, ["drive", "simulate", "--channel", "vcan0"])
    assert result.exit_code == 1
    assert "CAN interface 'vcan0': this kernel has no CAN sockets" in said(result)
    assert "take --interface udp_multicast" in said(result)
    assert "interface='ebac'" not in said(result)


def test_simulate_refuses_a_channel_whose_node_ids_are_taken() -> None:
    """Two drives with one node id would answer every request twice, and each would be set up by half."""
    words = ["drive", "simulate", "--interface", "virtual", "--channel", "full", "--seconds", "0.2"]
    with (
        can.Bus(interface="virtual", channel="full") as bus,
        Simulation(bus, Joystick(resting_joystick().setup())),
    ):
        result = CliRunner().invoke(app, words)
        free = CliRunner().invoke(app, [*words, "--first", "3"])
    assert result.exit_code == 1
    assert (
        "virtual full: there are drives with these node ids already: 1, 2; end the other"
        in said(result)
    )
    assert free.exit_code == 0, free.output


def test_simulate_refuses_a_first_node_id_whose_last_one_is_none() -> None:
    words = ["drive", "simulate", "--interface", "virtual", "--channel", "last", "--seconds", "0.1"]
    result = CliRunner().invoke(app, [*words, "--device", "joystick-3", "--first", "126"])
    assert result.exit_code == 2
    assert "--first = 126: must lie in [1, 125] for 3 drives" in said(result)


def test_each_node_id_is_asked_for_and_a_bus_that_fails_is_an_error_of_the_bus(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[int] = []

    def full(message: can.Message, *_: Any) -> None:
        asked.append(message.arbitration_id)
        raise (OSError if len(asked) == 1 else can.CanOperationError)("nobody acknowledges")

    def down(*_: Any) -> None:
        raise can.CanOperationError("no such device")

    with can.Bus(interface="virtual", channel="none") as bus:
        monkeypatch.setattr(bus, "send", full)
        refuse_taken(bus, "virtual none", [1, 2])
        assert asked == [0x601, 0x602]
        monkeypatch.setattr(bus, "recv", down)
        with pytest.raises(drives.BusError, match=r"virtual none: the bus failed \(no such device"):
            refuse_taken(bus, "virtual none", [1, 2])


def test_simulate_looks_for_taken_node_ids_on_socketcan_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """By python-can, before the drives of C++ are there; here it meets another bus."""

    def virtual(**_given: Any) -> can.BusABC:
        return can.Bus(interface="virtual", channel="can9")

    monkeypatch.setattr(bus_module, "open_bus", virtual)
    with virtual() as bus, Simulation(bus, Joystick(resting_joystick().setup())):
        result = CliRunner().invoke(app, ["drive", "simulate", "--channel", "can9"])
    assert result.exit_code == 1
    assert "socketcan can9: there are drives with these node ids already: 1, 2;" in said(result)


@pytest.mark.parametrize("command", ["scan", "simulate"])
def test_a_bus_that_does_not_open_leaves_one_message(
    command: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """python-can warns of a bus half made, when it is freed."""

    class HalfMade(can.BusABC):
        send: Any = None

        def __init__(self, **_given: Any) -> None:
            super().__init__("x")
            raise OSError(errno.ENODEV, "No such device")

    monkeypatch.setattr(can, "Bus", HalfMade)
    result = CliRunner().invoke(app, ["drive", command, "--interface", "slcan", "--channel", "x"])
    assert "interface slcan, channel x: No such device; there is no such interface" in said(result)
    del result
    gc.collect()
    assert "shut down" not in caplog.text


@pytest.mark.slow
@pytest.mark.real_time  # multicast drops frames that nobody takes in time
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_drives_in_another_process_are_set_up_and_end_by_a_signal(
    number: signal.Signals, tmp_path: Path
) -> None:
    """Between processes, over multicast on this machine: `simulate` here, all else there."""
    pytest.importorskip("msgpack")
    channel = f"239.{os.getpid() % 250}.74.{163 + number}"
    bus = ["--interface", "udp_multicast", "--channel", channel]
    environment = os.environ | {"XDG_STATE_HOME": str(tmp_path)}
    code = "from ebac.cli import app; app()"
    with subprocess.Popen(
        [sys.executable, "-c", code, "drive", "simulate", *bus],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment,
    ) as served:  # fmt: skip
        try:
            assert served.stdout is not None
            first = served.stdout.readline()
            if "Simulated drives" not in first:
                pytest.skip(f"no multicast here: {first}")
            with drives.DriveBus.open(interface="udp_multicast", channel=channel) as opened:
                (node,) = drives.load("joystick", nodes=[2]).nodes
                drive = opened.drive(2, timeout=10.0)
                drives.apply(drive, node, backups=drives.Backups(tmp_path))
                with drive:
                    drive.enable()
                drives.restore(drive, backups=drives.Backups(tmp_path))
            served.send_signal(number)
            deadline = time.monotonic() + 10
            while served.poll() is None and time.monotonic() < deadline:
                time.sleep(0.02)
            assert served.returncode == 0
            assert "Stopped:" in served.stdout.read()
        finally:
            served.kill()


@pytest.mark.parametrize("columns", [80, 120])
def test_names_stand_whole_in_every_table(
    drive: Run, monkeypatch: pytest.MonkeyPatch, columns: int
) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    for words in (["plan", "joystick"], ["show", "--node", "1", "--all"]):
        text = drive(*words).output
        assert "…" not in text
        assert max(len(line) for line in text.splitlines()) <= columns
        assert "heartbeat_producer" in text
    assert "who made it" in text


def test_restore_does_not_point_to_a_backup_that_is_gone(drive: Run, tmp_path: Path) -> None:
    where = ["--backup", str(tmp_path / "kept"), "--yes"]
    assert " Backup: " in said(drive("apply", "joystick", *where))
    text = said(drive("restore", *where))
    assert " Backup: " not in text
    assert "has served and is gone" in text
    assert not list((tmp_path / "kept").glob("*.json"))
