"""`ebac run --virtual`, and what a run says that a late machine ended."""

import json
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

import ebac
from ebac._util.doubts import configuration as doubtful
from ebac.cli import app
from ebac.cli.files import FigureOptions
from ebac.cli.run import names
from ebac.cli.run.live import lines
from ebac.hardware import Configuration, Run, under_the_law
from ebac.hardware.lateness import explained, lateness, lateness_of, loop_fault
from ebac.hardware.virtual_device import VirtualDevice
from ebac.simulation import LoopFault

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"
RUN = ["run", str(EXAMPLE), "--virtual", "--seconds", "1"]


def test_a_virtual_run_is_the_simulation_and_leaves_the_same_files(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, [*RUN, "--out", str(tmp_path / "out"), "--json"])
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    trace = Configuration.load(EXAMPLE).simulate(seconds=1)
    assert told["virtual"] is told["simulated"] is True
    assert told["rows"] == [ebac.contact(trace, truth=False).row()]
    assert told["ticks"] == told["recorded"] == len(trace)
    assert told["ended_by"] == "time"
    assert {file.suffix for file in (tmp_path / "out").iterdir()} == {".json", ".mcap", ".png"}
    (log,) = (tmp_path / "out").glob("*.mcap")
    np.testing.assert_array_equal(ebac.logs.load(log)["x"], trace["x"])


def test_a_first_run_prints_and_records_what_it_changes(tmp_path: Path) -> None:
    out = tmp_path / "out"
    before = EXAMPLE.read_bytes()
    asked = [*RUN, "--first", "--law", "tca", "--out", str(out)]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 0, done.output
    assert EXAMPLE.read_bytes() == before
    lines = [
        "environment: free air instead of a wall of 10 kN/m at 10 mm",
        "law.kp: 0 instead of 0.5, so that the law feeds no force back",
        "limits.peak_current: 0.1 A (1.08 N at the handle) instead of 3.941 A",
        "limits.continuous_current: 0.1 A (1.08 N at the handle) instead of 0.9851 A",
    ]
    assert [f"First run, {line}" for line in lines] == done.stdout.splitlines()[:4]
    (kept,) = out.glob("*.json")
    told = json.loads(kept.read_text(encoding="utf-8"))
    assert told["first_run"] == lines
    assert told["rows"][0]["verdict"] == "no contact"
    (log,) = out.glob("*.mcap")
    text = ebac.logs.read(log).about.files["configuration.toml"]
    assert text.startswith(before.decode())
    assert all(f"\n# {line}\n" in text for line in lines)


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (["--wall-stiffness", "100"], "--wall-stiffness: --first has no virtual world"),
        (["--engine-command", "cat"], "--engine-command: --first has no virtual world"),
        (
            ["--at", "0.5 environment.stiffness=2e4"],
            "--at 0.5 s: environment.stiffness: --first has neither",
        ),
        (
            ["--at", "0.1 hand.target=0", "--at", "0.5 law.kp=0.1"],
            "--at 0.5 s: law.kp: --first has neither a virtual",
        ),
    ],
)
def test_a_world_for_a_first_run_is_refused(other: list[str], message: str) -> None:
    clock = ["--simulated" if "--at" in other else "--virtual"]
    done = CliRunner().invoke(app, [*RUN[:2], *clock, "--first", *other])
    assert done.exit_code == 2
    assert message in " ".join(done.stderr.split())


def test_two_runs_of_one_second_have_names_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(names.time, "strftime", lambda *_: "run-now")
    assert [names.free_stem(tmp_path).name for _ in range(3)] == [
        "run-now",
        "run-now-2",
        "run-now-3",
    ]
    (tmp_path / "run-now-4.mcap").touch()
    assert names.free_stem(tmp_path).name == "run-now-5"
    for stem in ("run-now", "run-now-2", "run-now-3", "run-now-5"):
        names.leave(tmp_path / stem)
    assert [file.name for file in tmp_path.iterdir()] == ["run-now-4.mcap"]


def test_a_run_prints_what_it_ran_with() -> None:
    done = CliRunner().invoke(app, [*RUN, "--no-files", "--wall-stiffness", "5000"])
    text = " ".join(done.stdout.split())
    assert "Run with: a device (0.25 kg, 2 N s/m, sensor without noise) a hand (0.15 kg" in text
    assert "a wall of 5 kN/m at 10 mm 1 kHz, 1 sample of delay 1 s, seed 1" in text


def test_a_virtual_run_says_that_its_clock_is_virtual() -> None:
    done = CliRunner().invoke(app, [*RUN, "--no-files"])
    assert "on a virtual clock: every tick in time" in " ".join(done.stdout.split())


@pytest.mark.parametrize(
    ("skipped", "words"),
    [(1, "1 tick could not be kept and was"), (2, "2 ticks could not be kept")],
)
def test_skipped_ticks_are_counted_in_words(
    skipped: int, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    results = import_module("ebac.cli.run.results")
    names = [name for _, *three in results._TIMES for name in three if name]
    results._show_times(SimpleNamespace(**dict.fromkeys(names, 0.0), skipped=skipped))
    assert words in " ".join(capsys.readouterr().out.split())


def test_a_run_on_simulated_drives_says_what_of_it_was_real(
    capsys: pytest.CaptureFixture[str],
) -> None:
    results = import_module("ebac.cli.run.results")
    known = Configuration.load(EXAMPLE).replace(seconds=1.0)
    found = results.Result.of_virtual(known, known.simulate(), None, None)
    results.show(replace(found, virtual=False))
    shown = " ".join(capsys.readouterr().out.split())
    assert "on simulated drives on a bus inside this process" in shown
    assert "were simulated; clock and thread were real." in shown


def test_a_run_whose_parameters_changed_has_no_verdict(capsys: pytest.CaptureFixture[str]) -> None:
    results = import_module("ebac.cli.run.results")
    known = Configuration.load(EXAMPLE).replace(seconds=1.0)
    found = results.Result.of_virtual(known, known.simulate(), None, None)
    results.show(found)
    assert "there is no verdict" not in capsys.readouterr().out
    results.show(replace(found, changed=True))
    shown = " ".join(capsys.readouterr().out.split())
    assert "there is no verdict" in shown
    assert shown.count("verdict") == 1


@pytest.mark.parametrize("other", [["--simulated"], ["--at", "0.5 law.kp=0"], ["--detached"]])
def test_what_belongs_to_real_time_is_refused(other: list[str]) -> None:
    done = CliRunner().invoke(app, [*RUN, *other])
    assert done.exit_code == 2
    assert f"--virtual excludes {other[0]}, which" in " ".join(done.stderr.split())


def late_trace(fault: ebac.Fault) -> ebac.Trace:
    trace = Configuration.load(EXAMPLE).simulate(seconds=0.05)
    rows = len(trace)
    codes, late, skipped = np.zeros(rows, int), np.zeros(rows), np.zeros(rows, int)
    codes[-1], late[20], skipped[20] = int(fault), 0.0123, 12
    for name, values in (("fault", codes), ("lateness", late), ("skipped", skipped)):
        trace = trace.with_column(name, values)
    return trace


@pytest.mark.parametrize(
    ("fault", "column", "values", "words"),
    [
        (ebac.Fault.DRIVE_FAULT, "statusword", [0x1237, 0x1218], "axis 1 (node 2, statusword 0x1218)"),
        (ebac.Fault.DRIVE_DISABLED, "statusword", [0x1240, 0x1237], "axis 0 (node 1, statusword 0x1240)"),
        (ebac.Fault.DRIVE_EMERGENCY, "emergency", [0x2310, 0x3210],
         "axis 0 (node 1, error code 0x2310) and axis 1 (node 2, error code 0x3210)"),
        (ebac.Fault.DRIVE_SILENT, "age", [1, 20], "axis 1 (node 2, no process data for 20 ticks)"),
        (ebac.Fault.HEARTBEAT_LOST, "heartbeat", [5, 0], "axis 1 (node 2, NMT state 0)"),
        (ebac.Fault.HEARTBEAT_LOST, "heartbeat", [5, 5], ""),
        (ebac.Fault.OVERRUNS, "emergency", [0x2310, 0], ""),
    ],
)  # fmt: skip
def test_a_fault_of_a_drive_names_its_node(
    fault: ebac.Fault, column: str, values: list[int], words: str
) -> None:
    trace = late_trace(fault)
    shown = trace[f"bus.{column}"].copy()
    shown[-1] = values
    error = loop_fault(trace.with_column(f"bus.{column}", shown), (1, 2))
    cause = f"fault {int(fault)} ({fault.name.lower().replace('_', ' ')})"
    assert str(error).startswith(f"{cause}{words and f' of {words}'} in tick ")


class Ended(Run):
    def __init__(self, trace: ebac.Trace) -> None:
        self.rows = trace

    def end(self) -> None:
        pass

    def trace(self) -> ebac.Trace:
        return self.rows


@pytest.mark.parametrize(
    ("table", "named"),
    [
        ("[simulated.signs]\nmotor = [-1, 1]\n", "[simulated.signs] is other than [signs]"),
        ("[simulated.zero]\ncounts = [12345, -7]\n", "[simulated.zero] is other than [zero]"),
    ],
)
def test_wrong_wiring_is_not_passed_over(tmp_path: Path, table: str, named: str) -> None:
    file = tmp_path / "joystick.toml"
    file.write_text(EXAMPLE.read_text(encoding="utf-8") + "\n" + table, encoding="utf-8")
    done = CliRunner().invoke(app, ["run", str(file), "--virtual", "--seconds", "1", "--no-files"])
    assert done.exit_code == 2
    assert named in " ".join(done.output.split())


def test_a_fault_of_motion_speaks_of_lateness_where_ticks_were_skipped_only() -> None:
    late = late_trace(ebac.Fault.OVERSPEED)
    assert "skipped 12 ticks" in lateness_of(ebac.Fault.OVERSPEED, late)
    in_time = late.with_column("skipped", np.zeros(len(late), np.int32))
    assert lateness_of(ebac.Fault.OVERSPEED, in_time) == ""
    assert lateness_of(ebac.Fault.DRIVE_SILENT, in_time) != ""


@pytest.mark.parametrize("fault", [ebac.Fault.DRIVE_SILENT, ebac.Fault.WORKSPACE])
def test_a_fault_by_time_names_the_lateness_and_the_doctor(fault: ebac.Fault) -> None:
    with pytest.raises(LoopFault) as caught:
        Ended(late_trace(fault)).finish()
    notes = getattr(caught.value, "__notes__", [])
    if fault is ebac.Fault.WORKSPACE:
        assert notes == []
    else:
        assert "woke up to 12.3 ms late and skipped 12 ticks; `ebac doctor`" in notes[0]
        assert (
            "without hardware, or with nobody at the handle, let the loop be late: bus.silent = 50"
            in notes[0]
        )
        assert "or more; only then look at `bus.missing`, `bus.late`, cables" in notes[0]


def test_a_fault_of_speed_names_the_file_that_was_run() -> None:
    fault = LoopFault(ebac.Fault.OVERSPEED, late_trace(ebac.Fault.OVERSPEED))
    assert "run `ebac drive signs mine.toml`: a motor" in explained(fault, file="mine.toml")
    assert "run `ebac drive signs FILE`" in explained(fault)


def test_a_handle_that_is_too_fast_on_hardware_is_first_looked_at_for_a_wrong_sign() -> None:
    fault = loop_fault(late_trace(ebac.Fault.OVERSPEED))
    assert fault is not None
    order = ("the loop woke up", "run `ebac drive signs")
    places = [explained(fault).index(words) for words in order]
    assert places[0] > places[1]
    simulated = explained(fault, "--virtual instead of --simulated runs it on a virtual clock")
    assert [simulated.index(words) for words in order] == sorted(map(simulated.index, order))


def test_a_simulation_is_never_late() -> None:
    assert lateness(ebac.simulate(ebac.Scenario(seconds=0.01))) == ""


def test_the_command_offers_the_virtual_clock(capsys: pytest.CaptureFixture[str]) -> None:
    command = import_module("ebac.cli.run.carry_out")
    trace = late_trace(ebac.Fault.DRIVE_SILENT)
    with pytest.raises(LoopFault) as caught:
        Ended(trace).finish()
    known = Configuration.load(EXAMPLE)
    result = command.results.Result.of_virtual(known, trace, None, caught.value)
    with pytest.raises(typer.Exit) as end:
        command.give(replace(result, virtual=False), None, False, FigureOptions(), caught.value)
    assert end.value.exit_code == 1
    text = " ".join(capsys.readouterr().err.split())
    assert "fault 9 (drive silent)" in text
    assert "the loop woke up to 12.3 ms late" in text
    assert text.count("ebac doctor") == 1  # it stood in the note and in the table's text
    assert "`bus.missing`, `bus.late`, cables and termination" in text
    assert "--virtual instead of --simulated" in text


def test_the_test_of_the_signs_names_the_lateness_too(monkeypatch: pytest.MonkeyPatch) -> None:
    def late(*_: object, **__: object) -> None:
        Ended(late_trace(ebac.Fault.DRIVE_SILENT)).finish()

    monkeypatch.setattr("ebac.hardware.find_signs", late)
    done = CliRunner().invoke(app, ["drive", "signs", str(EXAMPLE), "--simulated", "--write"])
    assert done.exit_code == 1
    text = " ".join(done.stderr.split())
    assert "the loop woke up to 12.3 ms late" in text
    assert "bus.silent = 50 or more" in text
    assert text.endswith("nothing was written")


def edited(tmp_path: Path, old: str, new: str) -> str:
    text = EXAMPLE.read_text(encoding="utf-8")
    assert text.count(old) == 1, old
    file = tmp_path / "joystick.toml"
    file.write_text(text.replace(old, new), encoding="utf-8")
    return str(file)


def test_the_data_sheet_counts_on_a_virtual_clock_too(tmp_path: Path) -> None:
    known = Configuration.load(EXAMPLE)
    most = ebac.Limits.of(known.device).thermal_time
    file = edited(tmp_path, "speed = 1.0 # m/s\n", f"thermal_time = {1.5 * most} # s\n")
    words = ["run", file, "--virtual", "--seconds", "0.1", "--no-files"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 2, done.output
    assert "limits.thermal_time" in done.stderr
    assert "the motor may burn" in " ".join(done.stderr.split())
    assert "of an RE 30's winding, from memory" in " ".join(done.stderr.split())
    line = next(
        n for n, one in enumerate(Path(file).read_text().split("\n"), 1) if "thermal_time =" in one
    )
    assert f"joystick.toml, line {line}: limits.thermal_time" in "".join(done.stderr.split("\n"))
    allowed = CliRunner().invoke(app, [*words, "--beyond-rating"])
    assert allowed.exit_code == 0
    assert "limits.thermal_time = 24 s" in " ".join(allowed.stderr.split())
    little = known.replace(limits=known.limits.replace(thermal_time=1.04 * most))
    VirtualDevice(little, delay=1)  # 16 s are from memory
    beyond = known.replace(limits=known.limits.replace(thermal_time=1.5 * most))
    with pytest.raises(ebac.hardware.ConfigurationError, match="thermal_time"):
        VirtualDevice(beyond, delay=1)


@pytest.mark.parametrize("limit", [{"limits__max_current": 0.1}, {"limits__max_torque": 0.0054}])
@pytest.mark.parametrize("bus_time", [True, False])
def test_the_limits_of_the_drives_count_on_a_virtual_clock_too(
    limit: dict[str, float], bus_time: bool
) -> None:
    known = Configuration.load(EXAMPLE)
    nodes = [replace(one, profile=one.profile.replace(**limit)) for one in known.drives.nodes]
    weak = known.replace(drives=replace(known.drives, nodes=tuple(nodes)))
    trace = weak.simulate(seconds=1, bus_time=bus_time)
    assert np.abs(trace["bus.actual_permille"]).max() == 102
    assert np.abs(known.simulate(seconds=1)["bus.actual_permille"]).max() > 102
    (said,) = doubtful.doubts(weak)
    assert "node 1: limits.max_" in said
    assert "lets through 0.1005 A, 1.08 N at the handle, less than limits.peak_current" in said
    assert doubtful.doubts(known) == []


def test_drives_that_let_through_more_than_the_motor_is_to_take_are_noted() -> None:
    known = Configuration.load(EXAMPLE)
    device = known.device.replace(drive=known.device.drive.replace(peak_ratio=2.0))
    low = known.replace(device=device, limits=ebac.Limits.of(device))
    said = doubtful.doubts(low)
    keys = ["limits.max_torque", "limits.max_current", "motor.peak_torque"]
    assert [text.partition(": ")[2].partition(" = ")[0] for text in said] == keys
    assert said[0] == (
        "nodes 1, 2 of the built-in joystick: limits.max_torque = 0.212 N m, more than the peak of the device, 0.106 N "
        "m (device.drive.peak_ratio 2 x the motor's rating): the drive does not protect this motor; give at most 0.106 "
        "in the profile, or a higher peak_ratio where the motor takes more"
    )


def test_another_motor_without_a_thermal_time_of_its_own_is_noted() -> None:
    def said(text: str, **motor: float) -> list[str]:
        known = Configuration.from_toml(
            f'[bus]\ndrives = "handle"\n[device]\npreset = "reference"\n{text}'
        )
        device = known.device.replace(motor=known.device.motor.replace(**motor))
        found = doubtful.doubts(known.replace(device=device))
        return [one for one in found if "thermal" in one]

    (note,) = said("", rotor_inertia=14e-7)
    assert note.startswith("limits.thermal_time is not given: 16 s of an RE 30 are taken")
    assert said("[limits]\nthermal_time = 16.0\n", rotor_inertia=14e-7) == []
    assert said("") == []


def test_a_configuration_lists_its_doubts_and_its_simulation_warns_of_them() -> None:
    known = Configuration.load(EXAMPLE)
    assert known.doubts() == ()
    assert known.sensor is not None
    coarse = known.sensor.replace(counts_per_force=1.0)
    soft = known.replace(sensor=coarse, environment=ebac.Wall(stiffness=5.0))
    assert [text.partition(":")[0] for text in soft.doubts()] == [
        "environment.stiffness",
        "sensor.counts_per_force = 1 counts/(N)",
    ]
    with pytest.warns(ebac.DoubtWarning) as caught:
        soft.simulate(seconds=0.1)
    assert [str(one.message) for one in caught][:2] == list(soft.doubts())
    assert caught[0].filename == __file__


@pytest.mark.parametrize("opened", [ebac.Device.open, ebac.hardware.OpenDevice.open])
def test_a_device_that_is_opened_warns_of_the_doubts_of_its_configuration(opened: Any) -> None:
    """Before its drives are looked for: `simulate` and `ebac run` had them, real drives not."""
    soft = Configuration.load(EXAMPLE).replace(environment=ebac.Wall(stiffness=5.0))
    with pytest.warns(ebac.DoubtWarning) as caught, pytest.raises(ebac.drives.DriveError):
        opened(soft.replace(channel="no-such-bus"))
    assert [str(one.message) for one in caught] == list(soft.doubts())
    assert caught[0].filename == __file__


def test_drives_with_the_sync_period_of_another_rate_are_noted() -> None:
    known = Configuration.load(EXAMPLE)
    slower = known.replace(timing=known.timing.replace(dt=2e-3))
    (note,) = [one for one in doubtful.doubts(slower) if "sync.period" in one]
    assert note.startswith(
        "nodes 1, 2 of the built-in joystick: sync.period = 0.001 s in its profile, timing.dt = 0.002 s: `ebac run` "
    )
    assert "give sync.period = 0.002 in the profile and `ebac drive apply` it" in note
    assert doubtful.doubts(slower.replace(setup="apply")) == [], "a run writes it"
    without_drives = Configuration.from_toml("[timing]\ndt = 2e-3\n")
    assert not [one for one in doubtful.doubts(without_drives) if "sync.period" in one]


def test_a_rate_other_than_that_of_the_drives_is_noted() -> None:
    """The note of the file came before the option, so that a rate that no drive holds was taken in silence."""
    asked = [*RUN[:3], "--seconds", "0.05", "--no-files"]
    done = CliRunner().invoke(app, [*asked, "--rate", "500"])
    assert done.exit_code == 0, done.output
    words = " ".join(done.stderr.split())
    assert (
        "--rate 500: nodes 1, 2 of the built-in joystick: sync.period = 0.001 s in its profile, timing.dt = 0.002 s: "
        "`ebac run` takes timing.dt for 0x1006, and refuses a drive that holds anything else there"
    ) in words
    assert words.count("sync.period") == 2, "once, and in the remedy"
    assert "`ebac drive apply` it, or leave out --rate" in words
    assert "sync.period" not in CliRunner().invoke(app, [*asked, "--rate", "1000"]).stderr


def test_limits_that_hardly_protect_are_noted() -> None:
    known = Configuration.load(EXAMPLE)
    loose = known.replace(limits=known.limits.replace(speed=100.0, end=1.0, pause=0.2))
    said = doubtful.doubts(loose)
    assert [text.partition(":")[0] for text in said] == [
        "limits.speed = 100 m/s",
        "limits.end = 1 m",
    ]
    assert "the default for this device is 1.5 m/s" in said[0]


def test_a_wall_that_no_table_names_is_noted() -> None:
    text = EXAMPLE.read_text()
    before, _, rest = text.partition("[environment]")
    bare = Configuration.from_toml(before + rest[rest.index("[law]") :], name="bare")
    (said,) = doubtful.doubts(bare)
    assert "no [environment]: the default wall of 10000 N/m stands at 0 m" in said


@pytest.mark.parametrize("as_variant", [False, True])
def test_a_law_made_for_another_device_is_noted(as_variant: bool) -> None:
    known = Configuration.load(EXAMPLE)
    changes = {"mass": 0.6, "damping": 2.0, "peak_force": 42.38, "kp": 0.2}
    law = ebac.laws.Variant("ebac", changes) if as_variant else "ebac"
    other = known.replace(law=law, changes={} if as_variant else changes)
    (said,) = doubtful.doubts(other)  # neither what agrees, nor what no device has
    assert said.startswith("law.mass = 0.6 kg, but the device has 0.25 kg: ")
    several = {"count": 1e-4, "current_lag": 1e-3, "peak_force": 20.0}
    said = doubtful.doubts(known.replace(changes=several)).pop(0)
    assert said.startswith("law.count = 0.0001 m, but the device has 3.068e-05 m: ")
    assert len(doubtful.doubts(known.replace(changes=several))) == 3


def test_a_sensor_of_the_device_without_one_of_the_run_is_noted() -> None:
    text = EXAMPLE.read_text()
    before, _, rest = text.partition("[sensor]")
    bare = before + rest[rest.index("[recording]") :]
    described = bare + "[device.sensor]\nnoise = 0.05\n"
    (said,) = doubtful.doubts(Configuration.from_toml(described, name="bare"))
    assert said.startswith("[device.sensor] without [sensor]: this run has no force sensor")
    for quiet in (bare, text + "[device.sensor]\nnoise = 0.05\n", f"{described}fitted = false\n"):
        assert doubtful.doubts(Configuration.from_toml(quiet, name="quiet")) == []


def test_a_soft_wall_behind_the_stops_is_noted() -> None:
    known = Configuration.load(EXAMPLE)
    (said,) = doubtful.doubts(known.replace(limits=known.limits.replace(edge=0.06, end=0.07)))
    assert "limits.edge = 0.06 m: the stops lie before it, 0.05236 m from the middle" in said


def test_range_and_counts_of_the_sensor_count_on_a_virtual_clock_too() -> None:
    known = Configuration.load(EXAMPLE)
    assert known.sensor is not None
    coarse = known.replace(sensor=known.sensor.replace(counts_per_force=10.0)).simulate(seconds=1)
    force = coarse["f_meas"]
    assert np.ptp(force) > 1
    np.testing.assert_allclose(force, np.round(force, 1), atol=1e-9)
    small = known.replace(sensor=known.sensor.replace(force_range=2.0))
    with pytest.raises(ebac.LoopFault, match="force saturated") as stopped:
        small.simulate(seconds=2)
    assert np.abs(stopped.value.trace["f_meas"]).max() == 2.0
    run = VirtualDevice(small, delay=1).start(small.design(), small.environment)
    run.advance(2000)
    with pytest.raises(ebac.LoopFault, match="force saturated"):
        run.finish()


@pytest.mark.parametrize(("seconds", "soon"), [(5.0, False), (2.5, True)])
def test_the_view_of_a_run_asks_for_the_handle_before_the_force_fades(
    seconds: float, soon: bool
) -> None:
    known = Configuration.load(EXAMPLE).replace(seconds=seconds)
    run: Any = SimpleNamespace(law=known.design(), recorder=None)
    trace = under_the_law(known.simulate(seconds=1.0, bus_time=False))
    said = lines(known, run, trace)
    assert ("release the handle" in said[0]) is soon


def test_the_figure_of_a_run_has_a_panel_for_beta() -> None:
    from ebac.plot import plot_trace

    for law, panels in (("eba", 4), ("ebac", 4), ("tca", 3)):
        known = Configuration.load(EXAMPLE).replace(law=law, seconds=1.5)
        figure = plot_trace(known.simulate())
        labels = [ax.get_ylabel() for ax in figure.axes]
        assert len([label for label in labels if label]) == panels, law
        assert any("beta" in label for label in labels) == (panels == 4)


def test_a_handle_that_left_the_surface_has_no_contact_at_rest() -> None:
    back = ["--hand-target", "-0.02"]  # m: the wall is met on the way, if at all
    left = CliRunner().invoke(app, [*RUN, *back, "--no-files", "--json"])
    assert left.exit_code == 0, left.output
    (row,) = json.loads(left.stdout)["rows"]
    assert row["touched_at_rest"] is False
    (row,) = json.loads(CliRunner().invoke(app, [*RUN, "--no-files", "--json"]).stdout)["rows"]
    assert row["touched_at_rest"] is True
