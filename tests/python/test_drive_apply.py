"""Setting drives up, and taking it back: whole, or repaired by the next run, wherever it was cut."""

import dataclasses
import json
import os
from collections.abc import Callable, Iterator
from contextlib import nullcontext, suppress
from pathlib import Path
from typing import Any

import can
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ebac import drives
from ebac.drives import State
from ebac.drives.backup import Backup, state_folder
from ebac.drives.objects import known

Open = Callable[[], can.BusABC]

#: What moves by itself or is commanded, and no configuration.
VOLATILE = {
    "controlword", "statusword", "position", "velocity", "torque_demand", "actual_torque",
    "actual_current", "event_status", "error_register", "error_code",
}  # fmt: skip


class CutBus(can.BusABC):
    """A bus whose cable is cut at the n-th SDO download: that frame and all later ones go nowhere.

    `loud`: sending then raises, as an interface that is gone does; else it is silence.
    """

    def __init__(self, inner: can.BusABC, at: int, *, loud: bool) -> None:
        self.inner, self.left, self.loud = inner, at, loud
        self.channel_info = f"cut {inner.channel_info}"
        super().__init__(channel=None)

    @property
    def cut(self) -> bool:
        return self.left <= 0

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        download = 0x600 < msg.arbitration_id < 0x680 and msg.data[0] & 0xE0 == 0x20
        self.left -= download and not self.cut
        if not self.cut:
            self.inner.send(msg, timeout)
        elif self.loud:
            raise can.CanOperationError("the cable was cut")

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        return self.inner.recv(timeout), False

    def shutdown(self) -> None:
        super().shutdown()
        self.inner.shutdown()


@pytest.fixture
def shelf(tmp_path: Path) -> drives.Backups:
    return drives.Backups(tmp_path / "backups")


@pytest.fixture
def node() -> drives.Node:
    return drives.load("joystick").nodes[0]


@pytest.fixture
def bus(open_bus: Open) -> Iterator[drives.DriveBus]:
    """A cable that is never cut."""
    with drives.DriveBus(open_bus()) as opened:
        yield opened


def held(bus: drives.DriveBus, number: int = 1) -> dict[str, Any]:
    """Return all a drive is configured to."""
    drive = bus.drive(number)
    return {name: drive.look(name) for name in known() if name not in VOLATILE}


def prepare(bus: drives.DriveBus) -> None:
    """Give a drive another start than the one it has from the works, and power it."""
    drive = bus.drive(1)
    text = '[pdo.tpdo1]\nobjects = ["statusword", "actual_current"]\ntype = 3\n'
    text += '[pdo.tpdo2]\nobjects = ["velocity"]\ntype = 240\nevent = 0.5\n'
    profile = drives.profile.read_profile(drives.toml_positions.Source(name="start", text=text))
    scratch = Path(os.environ["XDG_STATE_HOME"]) / "scratch"
    drives.apply(drive, drives.Node(id=1, profile=profile), backups=drives.Backups(scratch))
    drive.write("max_torque", 700)
    drive.enable(mode=10)


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))


# --- the straight way ---


def test_apply_verify_restore(
    bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node
) -> None:
    start = held(bus)
    drive = bus.drive(1)
    planned = drives.plan(drive, node)
    assert held(bus) == start  # a plan writes nothing
    assert planned.changes
    with pytest.raises(drives.NotVerified, match="node 1 holds something else: mode"):
        drives.verify(drive, node)

    done = drives.apply(drive, node, backups=shelf)
    assert done.changes == planned.changes
    assert len(done.written) == len(planned.writes())
    assert not drive.state.powered
    drives.verify(drive, node)
    assert held(bus)["mode"] == 10

    again = drives.apply(drive, node, backups=shelf)
    assert (again.changes, again.written, again.backup) == ((), (), None)

    back = drives.restore(drive, backups=shelf)
    assert held(bus) == start
    assert not back.backup.exists() if back.backup else False
    with pytest.raises(drives.DriveError, match="nothing to restore: no backup of this drive in"):
        drives.restore(drive, backups=shelf)


def test_the_plan_names_object_now_wanted_and_why(bus: drives.DriveBus, node: drives.Node) -> None:
    rows = {change.object.name: change.row() for change in drives.plan(bus.drive(1), node).changes}
    assert rows["sync_period"] == {
        "node": 1, "object": "0x1006", "name": "sync_period", "now": 0, "wanted": 1000, "unit": "us",
        "why": "the loop's SYNC comes this often",
    }  # fmt: skip
    assert rows["tpdo1_entry2"]["wanted"] == 0x60640020


def test_apply_disables_first_and_leaves_the_other_drive_alone(
    bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node
) -> None:
    prepare(bus)
    other = held(bus, 2)
    assert bus.drive(1).state is State.OPERATION_ENABLED
    drives.apply(bus.drive(1), node, backups=shelf)
    assert bus.drive(1).state is State.SWITCH_ON_DISABLED
    with pytest.raises(ValueError, match="the drive is node 2"):
        drives.plan(bus.drive(2), node)
    assert held(bus, 2) == other


def test_two_profiles_one_after_the_other_are_taken_back_to_the_first_start(
    bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node
) -> None:
    start = held(bus)
    second = drives.Node(
        id=1, profile=node.profile.replace(limits__max_torque=0.1, drive__quick_stop=1)
    )
    drive = bus.drive(1)
    drives.apply(drive, node, backups=shelf)
    drives.apply(drive, second, backups=shelf)
    assert drive.read("max_torque") == 1887
    drives.restore(drive, backups=shelf)
    assert held(bus) == start


def test_an_object_the_drive_lacks_is_refused_before_anything_is_written(
    bus: drives.DriveBus, shelf: drives.Backups
) -> None:
    start = held(bus)
    text = '[pdo.rpdo1]\nobjects = ["target_torque"]\n'
    profile = drives.profile.read_profile(drives.toml_positions.Source(name="mine", text=text))
    (pdo,) = profile.pdos
    late = dataclasses.replace(profile, pdos=(dataclasses.replace(pdo, inhibit=0.1),))
    node = drives.Node(id=1, profile=late)
    with pytest.raises(
        drives.Refused, match=r"0x1400:3 rpdo1_inhibit \(key pdo\.rpdo1\.inhibit\)"
    ) as caught:
        drives.apply(bus.drive(1), node, backups=shelf)
    assert caught.value.absent
    assert held(bus) == start
    assert not shelf.folder.exists()


def test_a_change_is_text_with_units(bus: drives.DriveBus, node: drives.Node) -> None:
    found = {one.object.name: one for one in drives.plan(bus.drive(1), node).changes}
    assert found["sync_period"].shown == ("0", "1000 us")
    assert found["heartbeat_consumer"].shown == ("none", "node 127, 100 ms")
    assert found["tpdo1_entry2"].shown[1] == "position (32 bit)"
    assert str(found["sync_period"]) == (
        "sync_period (0x1006): 0 -> 1000 us (the loop's SYNC comes this often)"
    )


def test_a_value_the_drive_refuses_stops_half_way_and_says_so(
    bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node
) -> None:
    start = held(bus)
    drive = bus.drive(1)
    # Without a torque constant nothing but the drive knows that this current is none of its motor.
    limits = {"limits.rated_torque": 0.053, "limits.rated_current": 0.9, "drive.quick_stop": 1}
    wrong = drives.Node(id=1, profile=drives.Profile(name="mine", values=limits))
    with pytest.raises(drives.NotApplied) as caught:
        drives.apply(drive, wrong, backups=shelf)
    said = str(caught.value)
    assert "refused writing rated_current" in said
    assert "the drive works it out from the data of its motor, 985 mA" in said
    assert "limits.rated_current of the profile is 900 mA: correct limits.rated_current, or" in said
    assert "The drive is disabled (switch on disabled)" in str(caught.value)
    assert caught.value.left[0].startswith("rated_current")
    assert not drive.state.powered
    drives.restore(drive, backups=shelf)
    assert held(bus) == start


def test_store_asks_the_drive_to_keep_it(
    bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node
) -> None:
    assert drives.apply(bus.drive(1), node, backups=shelf, store=True).stored


# --- cut at every write ---


def steps_of(bus: drives.DriveBus, node: drives.Node) -> int:
    """Return how many downloads `apply` makes on a drive that is prepared: disable, then writes."""
    return len(drives.plan(bus.drive(1), node).writes()) + 1


def cut_apply(open_bus: Open, at: int, loud: bool, shelf: drives.Backups, node: drives.Node) -> str:
    bus = CutBus(open_bus(), at, loud=loud)
    with drives.DriveBus(bus) as opened, pytest.raises(drives.DriveError) as caught:
        drives.apply(opened.drive(1, timeout=0.1 if not loud else 0.3), node, backups=shelf)
    assert bus.cut
    return str(caught.value)


@pytest.mark.parametrize("loud", [True, False], ids=["gone", "silent"])
@pytest.mark.slow
def test_cut_at_any_write_a_second_run_repairs_and_restore_takes_all_back(
    open_bus: Open, bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node, loud: bool
) -> None:
    prepare(bus)
    start = held(bus)
    writes = steps_of(bus, node)
    assert writes > 15
    for at in range(2, writes + 1, 1 if loud else 3):  # the first download disables
        bus.drive(1).enable()
        said = cut_apply(open_bus, at, loud, shelf, node)
        assert f"stopped after {at - 2} of {writes - 1} writes" in said
        assert "was disabled before the first write" in said
        drive = bus.drive(1)
        assert not drive.state.powered
        kept = shelf.load(drive)
        assert kept is not None
        assert {drives.find(key).name for key in kept.held} <= set(start)
        drives.apply(drive, node, backups=shelf)
        drives.verify(drive, node)
        drives.restore(drive, backups=shelf)
        assert held(bus) == start, at


@pytest.mark.parametrize("loud", [True, False], ids=["gone", "silent"])
@pytest.mark.slow
def test_restore_cut_at_any_write_is_finished_by_the_next(
    open_bus: Open, bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node, loud: bool
) -> None:
    prepare(bus)
    start = held(bus)
    writes = steps_of(bus, node) - 1
    for at in range(1, writes, 2 if loud else 5):
        drives.apply(bus.drive(1), node, backups=shelf)
        cable = CutBus(open_bus(), at, loud=loud)
        with drives.DriveBus(cable) as severed, pytest.raises(drives.DriveError):
            drives.restore(severed.drive(1, timeout=0.1 if not loud else 0.3), backups=shelf)
        drives.restore(bus.drive(1), backups=shelf)
        assert held(bus) == start, at


def test_interrupted_between_two_writes_says_where_and_leaves_it_disabled(
    bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node
) -> None:
    def interrupt(done: int, total: int) -> None:
        if done == 3:
            raise KeyboardInterrupt

    prepare(bus)
    with pytest.raises(KeyboardInterrupt) as caught:
        drives.apply(bus.drive(1), node, backups=shelf, progress=interrupt)
    assert "node 1: interrupted after 3 of" in caught.value.__notes__[0]
    assert "The drive is disabled (switch on disabled)" in caught.value.__notes__[0]
    assert not bus.drive(1).state.powered


def test_cut_before_the_drive_is_disabled_nothing_is_written(
    open_bus: Open, bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node
) -> None:
    prepare(bus)
    start = held(bus)
    cut_apply(open_bus, 1, True, shelf, node)
    assert held(bus) == start
    assert not shelf.folder.exists()


@given(cuts=st.lists(st.integers(2, 24), min_size=1, max_size=4))
@settings(max_examples=5, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_cut_again_and_again_restore_still_knows_the_start(
    open_bus: Open, bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node, cuts: list[int]
) -> None:
    start = held(bus)
    for at in cuts:
        with drives.DriveBus(CutBus(open_bus(), at, loud=True)) as severed:
            try:
                drives.apply(severed.drive(1), node, backups=shelf)
            except drives.DriveError:
                continue
    if shelf.load(bus.drive(1)) is not None:
        drives.restore(bus.drive(1), backups=shelf)
    assert held(bus) == start


# --- backups ---

HELD = st.dictionaries(
    st.tuples(st.integers(0, 0xFFFF), st.integers(0, 0xFF)), st.binary(min_size=1, max_size=8)
)


@given(held=HELD, more=HELD, node=st.integers(1, 127))
def test_a_backup_reads_back_and_keeps_its_first_values(
    held: dict[tuple[int, int], bytes], more: dict[tuple[int, int], bytes], node: int
) -> None:
    one = Backup(node=node, identity={"serial_number": 7}, held=held)
    assert Backup.from_json(one.to_json()) == one
    both = one.with_more(more)
    assert both.held == {**more, **held}
    json.loads(both.to_json())


@pytest.mark.parametrize(
    "text", ["", "{}", "[]", '{"node": 1}', '{"node":1,"identity":{},"objects":[{}]}']
)
def test_what_is_no_backup_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="not a backup of a drive"):
        Backup.from_json(text)


def test_a_backup_is_of_one_drive_and_a_broken_one_is_reported(
    bus: drives.DriveBus, shelf: drives.Backups, node: drives.Node
) -> None:
    drives.apply(bus.drive(1), node, backups=shelf)
    with pytest.raises(drives.DriveError, match="node 2: nothing to restore"):
        drives.restore(bus.drive(2), backups=shelf)
    path = shelf.path(bus.drive(1))
    path.write_text("{", encoding="utf-8")
    with pytest.raises(
        drives.DriveError, match=r"not a backup of a drive.*move it away, or mend it"
    ):
        drives.restore(bus.drive(1), backups=shelf)


def test_without_a_backup_nothing_is_written(
    bus: drives.DriveBus, node: drives.Node, tmp_path: Path
) -> None:
    start = held(bus)
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(
        drives.DriveError, match=r"cannot be written .* Nothing was written to the drive"
    ):
        drives.apply(bus.drive(1), node, backups=drives.Backups(tmp_path / "file"))
    assert held(bus) == start


def test_backups_lie_in_the_state_folder_of_the_user(tmp_path: Path) -> None:
    assert state_folder() == tmp_path / "state" / "ebac" / "drives"


# --- two profiles, one after the other ---

_NUMBERS = {
    "motor.torque_constant": st.sampled_from([0.02, 0.0538, 0.06, 0.2]),
    "motor.peak_torque": st.sampled_from([0.05, 0.1, 0.212, 1.0]),
    "limits.max_torque": st.sampled_from([0.02, 0.05, 0.1, 0.2]),
    "limits.max_current": st.sampled_from([0.1, 0.5, 2.0, 3.94]),
    "torque.slope": st.sampled_from([1.0, 100.0, 1000.0]),
}


@st.composite
def profiles(draw: st.DrawFn) -> drives.Profile:
    """Any profile that the drive, which works out rated torque and current itself, can hold."""
    values: dict[str, Any] = {"drive.quick_stop": draw(st.sampled_from([0, 1, 2]))}
    rated = draw(st.sampled_from([0.02, 0.053, 0.1]))
    values |= {name: draw(numbers) for name, numbers in _NUMBERS.items() if draw(st.booleans())}
    constant = values.setdefault("motor.torque_constant", 0.0538)
    values["motor.continuous_torque"] = values["limits.rated_torque"] = rated
    values["limits.rated_current"] = round(rated / constant, 3)
    for one in ("max_torque", "max_current"):
        most, base = values.get(f"limits.{one}"), values[f"limits.rated_{one[4:]}"]
        if most is not None:
            values[f"limits.{one}"] = max(most, base / 50)
    return drives.Profile(name="any", values=values)


class Rules:
    """A drive that takes some values only where they fit others, and no rated ones."""

    def __init__(self, drive: drives.Drive, monkeypatch: pytest.MonkeyPatch, strict: bool) -> None:
        whole, sdo = type(drive.sdo).download, drive.sdo

        def fits(name: str, value: int) -> bool:
            names = ("motor_peak_torque", "motor_continuous_torque", "max_torque")
            if name not in names or not strict:
                return True
            held = {key: value if key == name else int(drive.look(key) or 0) for key in names}
            most = 1000 * held["motor_peak_torque"] / held["motor_continuous_torque"]
            return held["max_torque"] <= most + 1

        def download(obj: drives.Object, data: bytes) -> None:
            value = int.from_bytes(data, "little")
            if not fits(obj.name, value):
                raise drives.Refused(drive.node, obj, "writing", 0x06090030)
            whole(sdo, obj, data)

        monkeypatch.setattr(sdo, "download", download)


@settings(max_examples=12, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(first=profiles(), second=profiles(), strict=st.booleans())
@pytest.mark.slow
def test_two_profiles_in_a_row_are_undone(
    first: drives.Profile, second: drives.Profile, strict: bool, open_bus: Open, tmp_path: Path
) -> None:
    shelf = drives.Backups(tmp_path / "two")
    with drives.DriveBus(open_bus()) as bus, pytest.MonkeyPatch.context() as patch:
        drive, before = bus.drive(1), held(bus)
        Rules(drive, patch, strict)
        for profile in (first, second):
            # A profile may ask for what the strict drive never takes.
            with suppress(drives.NotApplied) if strict else nullcontext():
                drives.apply(drive, drives.Node(id=1, profile=profile), backups=shelf)
        if shelf.load(drive) is not None:
            drives.restore(drive, backups=shelf)
        assert held(bus) == before


def test_a_profile_with_a_motor_and_then_one_with_limits_alone_are_undone(
    bus: drives.DriveBus, shelf: drives.Backups
) -> None:
    """The rated current is read only, and worked out from motor data that come later in the backup."""
    before, drive = held(bus), bus.drive(1)
    limits = {"limits.rated_torque": 0.1, "limits.rated_current": 1.667, "drive.quick_stop": 1}
    motor = {
        "motor.torque_constant": 0.06,
        "motor.continuous_torque": 0.1,
        "limits.rated_torque": 0.1,
        "limits.rated_current": 1.667,
    }
    for values in (motor, limits):
        profile = drives.Profile(name="mine", values=values)
        drives.apply(drive, drives.Node(id=1, profile=profile), backups=shelf)
    assert drive.number("rated_current") == 1667
    drives.restore(drive, backups=shelf)
    assert held(bus) == before
