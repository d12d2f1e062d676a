"""The zero of the encoders: read, written into the file, subtracted in the loop, confirmed before real power."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from busy_machine import patient_file
from hypothesis import example, given
from hypothesis import strategies as st
from typer.testing import CliRunner, Result

import ebac
from ebac import drives
from ebac._core import DriveWiring, Joystick, LoopbackJoystick
from ebac.can.channels import resting_joystick, standing
from ebac.cli import app
from ebac.hardware import (
    Configuration,
    PositionError,
    Signs,
    Zero,
    axis_positions,
    backends,
    distances,
    under_the_law,
)
from ebac.hardware.axis_positions import check_outside, positions_at_zero, positions_of
from ebac.hardware.backends import Backend
from ebac.hardware.toml_table import rewrite
from ebac.hardware.zero import LEAST, MOST, from_zero
from ebac.worlds import Box, World

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"
#: What the drives show with the handle at its zero: 12345 counts are 0.38 m at the handle.
BEGIN = (12345, -7)
#: 6.1 mm at the handle.
FEW = 200
KNOWN = Configuration.load(EXAMPLE)
INT32 = st.integers(LEAST, MOST)
_numbers = count()


def text_of(**more: str) -> str:
    """The example, patient with a busy machine and without a sensor; text to replace by name of the key."""
    text = patient_file(EXAMPLE.read_text(encoding="utf-8"))
    text = text[: text.index("[sensor]")] + text[text.index("[recording]") :]
    for before, after in {"seconds = 10.0": "seconds = 0.3", **more}.items():
        assert before in text, before
        text = text.replace(before, after)
    return text


def simulated(
    text: str, *, zero: tuple[int, ...], simulated_zero: tuple[int, ...]
) -> Configuration:
    """A device whose simulated drives begin somewhere; its hand stays at the true zero, in an empty world."""
    known = Configuration.from_toml(text)
    hand = known.hand.replace(path=[ebac.Step(target=0.0)] * 2)
    return known.replace(
        environment=ebac.Free(),
        hand=hand,
        zero=Zero(counts=zero),
        simulated_zero=Zero(counts=simulated_zero),
    )


@pytest.fixture
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A configuration of drives that `ebac` takes for real ones; their counters stand at `BEGIN`."""
    from ebac.hardware import device

    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))

    @contextmanager
    def real(known: Configuration) -> Iterator[Backend]:
        with backends.hardware(known) as backend:
            yield replace(backend, real=True)

    monkeypatch.setattr(device, "hardware", real)
    channel = f"mine-{next(_numbers)}"
    path = tmp_path / "mine.toml"
    bus = {'"socketcan"': '"ebac"', '"can0"': f'"{channel}"', '"verify"': '"apply"'}
    path.write_text(text_of(**bus), encoding="utf-8")

    def nodes(hub: Any) -> LoopbackJoystick:
        return LoopbackJoystick(
            hub, resting_joystick().setup(), wiring=DriveWiring(zero=list(BEGIN))
        )

    with standing(channel, nodes):
        yield path


def command(*words: str, **more: Any) -> Result:
    return CliRunner().invoke(app, list(words), **more)


def said(result: Result) -> str:
    return " ".join(result.output.split())


# --- what stands in the file ---


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("counts = [1]", "must be a list of 2 whole numbers"),
        ("counts = 5", "must be a list of 2 whole numbers"),
        ("counts = [1, 2.5]", "zero.counts = [1, 2.5]"),
        ("counts = [1, true]", "one for each axis"),
        ("counts = [0, 2147483648]", "in [-2147483648, 2147483647] counts"),
        ("absolute = true", "needs zero.counts"),
        ("counts = [1, 2]\nabsolute = 1", "must be true or false"),
        ("count = [1, 2]", "did you mean 'counts'"),
    ],
)
def test_a_zero_that_cannot_be_is_refused_with_its_line(table: str, words: str) -> None:
    text = EXAMPLE.read_text(encoding="utf-8") + f"\n[zero]\n{table}\n"
    with pytest.raises(ebac.hardware.ConfigurationError, match="line ") as caught:
        Configuration.from_toml(text)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "",
        'about = "x"',
        "[zero] # mine\nabsolute = true # a resolver\ncounts = [1, 1] # left\n\n[run]\nseconds = 1.0\n",
        "[zero]\n[run]\nseconds = 1.0\n",
        "[run]\nseconds = 1.0\n[zero]",
        "[run]\nseconds = 1.0\n[zero]\nabsolute = false",
    ],
)
def test_it_is_written_line_by_line(text: str) -> None:
    made = Zero(counts=(-5, MOST)).written_into(text)
    known = Configuration.from_toml(made)
    assert known.zero == Zero(counts=(-5, MOST), absolute="absolute = true" in text)
    for comment in ("# mine", "# left", "# a resolver"):
        assert (comment in made) == (comment in text)


@pytest.mark.parametrize("table", ["", "[zero] # mine\r\ncounts = [1, 1] # left\r\n", "[zero]"])
def test_line_ends_and_links_stay(table: str, tmp_path: Path) -> None:
    path, link = tmp_path / "rig" / "mine.toml", tmp_path / "linked.toml"
    path.parent.mkdir()
    before = f"# of the rig\r\n[run]\r\nseconds = 1.0\r\n{table}".encode()
    path.write_bytes(before)
    link.symlink_to(path)
    rewrite(link, Zero(counts=(-5, MOST)).written_into)
    assert link.is_symlink()
    after = path.read_bytes()
    assert Configuration.load(link).zero == Zero(counts=(-5, MOST))
    kept = [line for line in before.splitlines() if not line.startswith(b"counts")]
    assert after.replace(b"\r\n", b"").count(b"\n") == 0
    assert set(kept) <= set(after.splitlines())
    assert [file.name for file in path.parent.iterdir()] == [path.name]


# --- counts that wrap around ---


@given(zero=INT32, way=INT32)
@example(zero=MOST, way=1)
@example(zero=LEAST, way=-1)
def test_the_way_from_the_zero_survives_the_wrap_around(zero: int, way: int) -> None:
    shown = (zero + way - LEAST) % 2**32 + LEAST
    assert LEAST <= shown <= MOST
    assert from_zero(shown, zero) == way


@given(zero=INT32, way=st.integers(-1000, 1000), sign=st.sampled_from([1, -1]))
@example(zero=MOST, way=1, sign=-1)
def test_where_an_axis_stands_is_the_same_for_every_zero(zero: int, way: int, sign: int) -> None:
    signs = Signs(motor=(1, 1), encoder=(sign, 1))
    known = KNOWN.replace(zero=Zero(counts=(zero, 0)), signs=signs)
    shown = (zero + way - LEAST) % 2**32 + LEAST
    first, second = positions_of(known, [shown, 0])
    assert first.position_m == pytest.approx(sign * way * known.device.count)
    assert first.angle_rad == pytest.approx(first.position_m / known.device.radius)
    assert second.position_m == 0


@pytest.mark.parametrize("told", [1, -1])
@pytest.mark.parametrize("needed", [1, -1])
def test_a_simulated_encoder_is_read_as_a_real_one(told: int, needed: int) -> None:
    """What the drive shows is turned by [signs] alone, however the simulated device is wired."""
    known = KNOWN.replace(
        signs=Signs(motor=(1, 1), encoder=(1, told)),
        simulated_signs=Signs(motor=(1, 1), encoder=(1, needed)),
        simulated_zero=Zero(counts=(300, -700)),
    )
    first, second = axis_positions(known, simulate=True)
    assert (first.counts, second.counts) == (300, -700)
    assert second.position_m == pytest.approx(told * -700 * known.device.count)


@pytest.mark.parametrize(
    ("world", "expected"),
    [
        (ebac.Free(), {}),
        (ebac.Wall(position=0.01), {"wall": 0.01 - 0.0306796}),
        (ebac.Wall(position=0.01, angle=np.pi / 2), {"wall": 0.01}),
        (
            ebac.Corner(first=ebac.Wall(position=0.05), second=ebac.Wall(angle=np.pi / 2)),
            {"first wall": 0.05 - 0.0306796, "second wall": 0.0},
        ),
        (ebac.Disc(x=0.0306796, y=0.03, radius=0.02), {"disc": 0.01}),
    ],
)
def test_the_distance_of_the_world_is_that_of_its_surfaces(
    world: Any, expected: dict[str, float]
) -> None:
    known = KNOWN.replace(environment=world)
    found = distances(known, positions_of(known, [1000, 0]))
    assert found == pytest.approx(expected, abs=1e-6)


# --- in the loop, on simulated drives ---


@pytest.mark.real_time
def test_drives_that_began_elsewhere_move_the_world_without_a_zero(tmp_path: Path) -> None:
    text = text_of()
    count_m = Configuration.from_toml(text).device.count
    wrong = simulated(text, zero=(0, 0), simulated_zero=(FEW, 0))
    right = simulated(text, zero=(FEW, -3), simulated_zero=(FEW, -3))
    for known, x in ((wrong, FEW * count_m), (right, 0.0)):
        log = tmp_path / f"{x}.mcap"
        with ebac.Device.open(known, simulate=True) as device:
            trace = under_the_law(device.run(log=log))
            report = device.report
        assert trace["x"][-1] == pytest.approx([x, 0.0], abs=2 * count_m)
        assert report is not None
        assert [one.counts for one in report.positions] == [
            FEW,
            known.counts_of_simulated_drives[1],
        ]
        assert [one.zero_counts for one in report.positions] == list(known.zero.counts)
        attached = json.loads(ebac.logs.read(log).about.files["positions.json"])
        assert attached == [one.row() for one in report.positions]


@pytest.mark.real_time
def test_a_zero_beyond_the_wrap_around_is_one_as_any() -> None:
    known = simulated(text_of(), zero=(MOST, LEAST), simulated_zero=(MOST, LEAST))
    with ebac.Device.open(known, simulate=True) as device:
        trace = under_the_law(device.run())
    assert np.abs(trace["x"]).max() < 5 * known.device.count


def test_an_axis_outside_the_workspace_gets_no_power() -> None:
    known = simulated(text_of(), zero=(), simulated_zero=BEGIN)
    with ebac.Device.open(known, simulate=True) as device:
        with pytest.raises(PositionError) as caught:
            device.run()
        assert device.positions()[0].position_m == pytest.approx(BEGIN[0] * known.device.count)
    message = str(caught.value)
    for words in (
        "axis 0 (node 1)",
        "+378.74 mm",
        "12345 counts",
        "within 57.3599 mm",
        "ebac drive zero",
    ):
        assert words in message


INSIDE = ebac.Wall(position=-0.01)
CUBE = World(Box(width=0.02, depth=0.02, height=0.02))


@pytest.mark.parametrize(
    ("world", "words"),
    [
        (INSIDE, "10.00 mm inside the wall and would be pushed with 100 N"),
        (ebac.Corner(first=ebac.Wall(position=0.02), second=INSIDE), "inside the second wall"),
        (ebac.Disc(x=0.01, radius=0.02), "10.00 mm inside the disc"),
        (ebac.Disc(x=0.0, radius=0.02), "20.00 mm inside the disc"),  # in its centre
        (CUBE, "mm inside the body 1"),
    ],
)
def test_a_handle_inside_the_world_gets_no_power(world: Any, words: str) -> None:
    known = simulated(text_of(), zero=(), simulated_zero=())
    with ebac.Device.open(known, simulate=True) as device:
        with pytest.raises(PositionError) as caught:
            device.run(environment=world)
        assert device.report is None
        assert device.positions()  # no drive has power
    with pytest.raises(PositionError) as virtual:
        known.replace(environment=world).simulate(seconds=0.1)
    for message in (str(caught.value), str(virtual.value)):
        assert words in message
        assert "Nothing has power" in message


@pytest.mark.parametrize(
    "world",
    [
        ebac.Wall(position=-5e-4),  # as exactly as a hand holds the handle at its mark
        ebac.Wall(stiffness=300.0, position=-3e-3),  # soft: 0.9 N
        ebac.Wall(stiffness=0.0, damping=40.0, position=-0.04),  # it only damps
    ],
)
def test_a_handle_at_the_surface_or_in_something_soft_begins(world: ebac.Wall) -> None:
    check_outside(KNOWN, positions_at_zero(KNOWN), world)


def test_the_command_refuses_a_wall_around_the_handle() -> None:
    result = CliRunner().invoke(
        app, ["run", str(EXAMPLE), "--virtual", "--no-files", "--wall-position", "-0.01"]
    )
    assert result.exit_code == 1
    assert "10.00 mm inside the wall" in " ".join(result.output.split())


@pytest.mark.parametrize(
    ("zero", "words"),
    [
        ([1], r"drive\.zero has 1 value: must have 2, one for each axis"),
        (
            [0, MOST + 1],
            r"drive\.zero = 2147483648 counts: must lie in \[-2147483648, 2147483647\]",
        ),
    ],
)
def test_the_counter_of_a_simulated_drive_has_32_bits(zero: list[int], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Joystick(resting_joystick().setup(), wiring=DriveWiring(zero=zero))


def test_a_counter_of_a_simulated_drive_is_given_for_each_axis() -> None:
    done = command("drive", "simulate", "--zero", "-7")
    assert done.exit_code == 2
    assert "--zero: 1 number for 2 axes" in said(done)


# --- ebac drive zero ---


def test_the_command_reads_and_writes_the_zero(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(text_of() + "\n[simulated.zero]\ncounts = [12345, -7]\n", encoding="utf-8")
    before = path.read_text(encoding="utf-8")
    done = command("drive", "zero", str(path), "--simulated", "--json")
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    assert [row["counts"] for row in told["rows"]] == list(BEGIN)
    assert told["written"] is False
    assert told["surfaces_m"] == {"wall": pytest.approx(0.01 - 0.378740)}
    assert path.read_text(encoding="utf-8") == before
    done = command("drive", "zero", str(path), "--simulated", "--write")
    assert "zero.counts = [12345, -7]" in said(done)
    assert "[zero] is of the simulated device; find it again on yours" in done.output
    mark = "counts = [12345, -7] # of the simulated device: find it again on yours\n"
    assert mark in path.read_text(encoding="utf-8")
    old, new = said(done).split("Written to")
    assert "By the old zero:" in old
    assert "368.74 mm inside the wall" in old
    assert "By the new zero:" in new
    assert "10.00 mm before the wall" in new
    assert set(before.splitlines()) <= set(path.read_text(encoding="utf-8").splitlines())
    done = command("drive", "zero", str(path), "--simulated")
    assert "10.00 mm before the wall" in said(done)
    assert "Nothing was written" in said(done)
    assert Configuration.load(path).zero == Zero(counts=BEGIN)


def test_on_real_drives_it_asks(mine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rehearsed = Zero(counts=(3, 4)).written_into(mine.read_text(encoding="utf-8"), simulated=True)
    mine.write_text(rehearsed, encoding="utf-8")
    before = mine.read_text(encoding="utf-8")
    done = command("drive", "zero", str(mine), "--write")
    assert done.exit_code == 2
    assert "add --yes" in said(done)
    here = SimpleNamespace(stdin=SimpleNamespace(isatty=lambda: True))
    monkeypatch.setattr("ebac.cli.drive.options.sys", here)
    assert command("drive", "zero", str(mine), "--write", input="n\n").exit_code == 1
    assert mine.read_text(encoding="utf-8") == before
    done = command("drive", "zero", str(mine), "--write", input="y\n")
    assert done.exit_code == 0, done.output
    assert Configuration.load(mine).zero == Zero(counts=BEGIN)
    assert "of the simulated device" not in mine.read_text(encoding="utf-8")


def test_a_handle_that_moves_meanwhile_is_no_zero(
    mine: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read = axis_positions(Configuration.load(mine))
    later = [replace(one, position_m=one.position_m + 1e-3) for one in read]
    answers = iter([read, later])
    monkeypatch.setattr(ebac.hardware, "axis_positions", lambda *_, **__: next(answers))
    before = mine.read_text(encoding="utf-8")
    done = command("drive", "zero", str(mine), "--write", "--yes")
    assert done.exit_code == 1
    assert "axis 0 (node 1) moved by +1.00 mm" in said(done)
    assert mine.read_text(encoding="utf-8") == before


def test_a_drive_with_power_is_not_read(mine: Path) -> None:
    known = Configuration.load(mine)
    with drives.DriveBus.open(interface="ebac", channel=known.channel) as bus:
        node = known.drives.nodes[0]
        drives.apply(bus.drive(node.id), node)
        with bus.drive(node.id) as drive:
            drive.enable()
            with pytest.raises(PositionError, match="node 1 has power"):
                axis_positions(known)
            done = command("drive", "zero", str(mine))
    assert done.exit_code == 1
    assert "node 1 has power" in said(done)


# --- confirmed before real motors have power ---


@pytest.mark.real_time
def test_real_drives_take_no_run_before_their_zero_is_confirmed(mine: Path) -> None:
    known = Configuration.load(mine).replace(zero=Zero(counts=BEGIN))
    with ebac.Device.open(known) as device:
        assert not device.confirmed
        with pytest.raises(PositionError, match=r"device\.confirm_zero\(\)"):
            device.run()
        device.confirm_zero()
        for _ in range(2):  # for all runs until the device is closed
            assert len(under_the_law(device.run())) == 300
        device.reset()  # of a fault that may have been a loss of power
        assert not device.confirmed
    with ebac.Device.open(known.replace(zero=Zero(counts=BEGIN, absolute=True))) as device:
        assert device.confirmed


@pytest.mark.real_time
def test_the_command_shows_where_the_axes_stand_and_asks(
    mine: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mine.write_text(Zero(counts=BEGIN).written_into(mine.read_text(encoding="utf-8")))
    run = partial(command, "run", str(mine), "--no-files")
    done = run()
    assert done.exit_code == 2
    assert "add --yes" in said(done)
    here = SimpleNamespace(stdin=SimpleNamespace(isatty=lambda: True))
    monkeypatch.setattr("ebac.cli.drive.options.sys", here)
    done = run(input="n\n")
    assert done.exit_code == 1
    assert "The handle is 10.00 mm before the wall." in said(done)
    assert "After 0.3 s every force fades within 0.2 s (run.ramp_down)" in said(done)
    assert "release the handle" in said(done)
    assert "nothing was done" in said(done)
    done = run("--wall-position", "-0.01", input="y\n")
    assert done.exit_code == 1
    assert "10.00 mm inside the wall and would be pushed" in said(done)
    assert "Is the handle where this says" not in said(done)
    done = run("--yes", "--json")
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    assert [row["zero_counts"] for row in told["positions"]] == list(BEGIN)
    assert "The handle is 10.00 mm before the wall." in " ".join(done.stderr.split())


def test_where_nobody_can_be_asked_no_bus_is_opened() -> None:
    done = command("run", str(EXAMPLE), "--no-files")
    assert done.exit_code == 2
    for words in ("Nobody is here to ask", "ebac drive zero", "add --yes"):
        assert words in said(done)
    done = command("run", str(EXAMPLE), "--no-files", "--yes")  # on to the next: there is no can0
    assert done.exit_code != 0
    assert "Nobody is here" not in said(done)


def test_simulated_drives_ask_nobody() -> None:
    known = Configuration.from_toml(text_of())
    with ebac.Device.open(known, simulate=True) as device:
        assert device.confirmed
