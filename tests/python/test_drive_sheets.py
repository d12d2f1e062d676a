"""Data sheets in the shapes of makers: read in any encoding, checked against profiles, under a simulated drive."""

import codecs
import sys
from pathlib import Path

import pytest

from ebac import _core, drives
from ebac.hardware.dictionary import dictionary

sys.path.insert(0, str(Path(__file__).parents[1] / "sheets"))
sys.path.insert(0, str(Path(__file__).parents[1] / "buses"))
from drive_through import drive_through
from maker_sheets import SHAPES, sheet
from simulated_bus import SimulatedBus

PROFILES = {
    "epos4": "maxon-epos4",
    "elmo": "elmo-gold",
    "tmcm": "trinamic-tmcm",
    "copley": "copley-guarded",
}


def read(maker: str) -> drives.Sheet:
    return drives.parse_eds(sheet(maker), name=f"{maker}.eds")


def written(folder: Path, text: str) -> drives.Network:
    path = folder / "own.toml"
    path.write_text(text)
    return drives.load(path, nodes=[1])


@pytest.mark.parametrize(
    ("encoding", "mark"),
    [("utf-8", b""), ("utf-8", codecs.BOM_UTF8), ("latin-1", b""), ("cp1252", b""),
     ("utf-16-le", codecs.BOM_UTF16_LE), ("utf-16-be", codecs.BOM_UTF16_BE), ("utf-16-le", b""), ("utf-16-be", b"")],
)  # fmt: skip
@pytest.mark.parametrize("maker", SHAPES)
def test_every_shape_is_read_in_every_encoding(
    tmp_path: Path, maker: str, encoding: str, mark: bytes
) -> None:
    path = tmp_path / "sheet.eds"
    path.write_bytes(mark + sheet(maker, note="Antriebsgröße, µ").encode(encoding))
    found = drives.read_eds(path)
    assert found.entries == read(maker).entries
    assert found.vendor == SHAPES[maker].vendor


def test_numbers_types_and_access_are_those_of_the_sheet() -> None:
    entries = read("copley").entries
    assert entries[0x1400, 1].default == 0x200
    assert entries[0x1400, 1].plus_node
    assert entries[0x1018, 1].default == 0xAB
    assert entries[0x6060, 0].kind == "u8"
    assert read("cia402").entries[0x6060, 0].access == "wo"
    assert read("epos4").entries[0x3001, 2].access == "rw"
    assert read("epos4").entries[0x1005, 0].access == "ro"
    text = "[6071]\nDataType=3\nDefaultValue=0xFFFE\nLowLimit=-012 ; octal\n[1003]\nObjectType=8\nCompactSubObj=3\n"
    odd = drives.parse_eds(text + "DataType=7\nAccessType=ro\n[1003Name]\n2=second\n").entries
    assert odd[0x6071, 0].default == -2
    assert odd[0x6071, 0].low == -10
    assert [odd[0x1003, sub].name for sub in (1, 2, 3)] == [".1", ".second", ".3"]
    with pytest.raises(drives.ProfileError, match="is no electronic data sheet"):
        drives.parse_eds("[DeviceInfo]\nVendorName=x\n")


@pytest.mark.parametrize("maker", PROFILES)
def test_the_profile_of_a_maker_goes_onto_its_drive_and_off_again(maker: str) -> None:
    network = drives.load(PROFILES[maker], nodes=[1])
    found = read(maker)
    drives.check_sheet(network, found)
    drives.check_stall(network)
    assert drive_through(found, network) > 10


def test_all_that_a_drive_lacks_is_listed_at_once_with_its_keys() -> None:
    network = drives.load("copley-accelnet", nodes=[1])
    expected = ["0x6072 max_torque (key limits.max_torque)", "0x1400:5 rpdo1_event (key pdo.rpdo1.event)",
                "0x2300 desired_state (key drive.desired_state)"]  # fmt: skip
    found = read("epos4")
    with pytest.raises(drives.ProfileError) as offline:
        drives.check_sheet(network, found)
    simulated = _core.SimulatedDrive(node=1, sheet=found.rows(1))
    with (
        drives.DriveBus(SimulatedBus(simulated)) as bus,
        pytest.raises(drives.Missing) as online,
    ):
        drives.plan(bus.drive(1), network.nodes[0])
    for part in expected:
        assert part in str(offline.value)
        assert part in str(online.value)
    for said in (str(offline.value), str(online.value)):
        assert said.index("Is this the right profile") < said.index("It lacks: ")
    assert len(online.value.lacking) == 9


@pytest.mark.parametrize("maker", ["elmo", "copley"])
def test_a_profile_that_says_a_drive_lacks_what_it_has_is_refused(maker: str) -> None:
    """Thousandths of 1 A on one drive are thousandths of its rated torque on another."""
    network = drives.load("trinamic-tmcm", nodes=[1])
    with pytest.raises(drives.ProfileError, match=r"lacks|`without` says that it does not"):
        drives.check_sheet(network, read(maker))
    if maker == "elmo":
        simulated = _core.SimulatedDrive(node=1, sheet=read(maker).rows(1))
        with (
            drives.DriveBus(SimulatedBus(simulated)) as bus,
            pytest.raises(drives.DriveError, match=r"has rated_torque \(0x6076\)"),
        ):
            drives.plan(bus.drive(1), network.nodes[0])


def test_a_position_drive_is_refused_whatever_the_profile() -> None:
    for profile in (*PROFILES.values(), "generic-cia402"):
        with pytest.raises(drives.ProfileError, match="0x6071 target_torque"):
            drives.check_sheet(drives.load(profile, nodes=[1]), read("position"))


def test_the_generic_profile_fits_the_sample_of_the_standard_with_a_mode_that_cannot_be_read(
    tmp_path: Path,
) -> None:
    """0x6060 write-only: the mode that acts (0x6061) stands for it."""
    network = drives.load("generic-cia402", nodes=[1])
    found = read("cia402")
    drives.check_sheet(network, found)
    assert drive_through(found, network) > 10


def test_a_simulated_drive_has_what_its_sheet_has_and_no_more() -> None:
    found = read("tmcm")
    simulated = _core.SimulatedDrive(node=5, sheet=found.rows(5))
    with drives.DriveBus(SimulatedBus(simulated)) as bus:
        drive = bus.drive(5, eds=found)
        for key, entry in found.entries.items():
            if key[0] != 0x1003:
                assert drive.look(key) is not None, entry
        for key in ((0x6073, 0), (0x1600, 4), (0x1400, 5), (0x2383, 12), (0x5F00, 0)):
            assert drive.look(key) is None
        assert drive.read((0x1018, 1)) == 0x286
        with pytest.raises(drives.Refused, match="read only"):
            drive.write((0x1014, 0), 0x85)


@pytest.mark.parametrize("maker", SHAPES)
def test_the_sheet_that_a_simulated_drive_gives_has_the_entries_of_its_own(maker: str) -> None:
    given = read(maker)
    own = drives.parse_eds(_core.SimulatedDrive(node=1, sheet=given.rows(1)).eds()).entries
    assert own.keys() == given.entries.keys()
    assert {key for key, entry in own.items() if entry.mappable} <= {
        key for key, entry in given.entries.items() if entry.mappable
    }


def test_a_sheet_prints_what_it_is_of_and_not_its_hundreds_of_entries() -> None:
    found = read("epos4")
    assert "epos4.eds" in repr(found)
    assert len(repr(found)) < 300


def test_a_name_of_ours_is_not_that_of_a_sheet() -> None:
    """A run reads "position" and writes "mode": whatever a maker calls so is something else."""
    entries = {
        (0x2000 + i, 0): drives.SheetEntry(index=0x2000 + i, name=name)
        for i, name in enumerate(("position", "Home"))
    }
    sheet_ = drives.Sheet(name="own", entries=entries)
    with drives.DriveBus(SimulatedBus(_core.SimulatedDrive())) as bus:
        drive = bus.drive(1, eds=sheet_)
        assert drive.object("position").index == 0x6064
        assert drive.object("Home").index == 0x2001


def test_a_sheet_of_another_maker_is_reported() -> None:
    simulated = _core.SimulatedDrive(node=1, sheet=read("elmo").rows(1))
    other = r"by vendor 0x9A, and tmcm\.eds is for vendor 0x286"
    with (
        drives.DriveBus(SimulatedBus(simulated)) as bus,
        pytest.raises(drives.DriveError, match=other),
    ):
        bus.drive(1, eds=read("tmcm")).check_sheet()


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('"0x6040" = 15', "commands the motor"),
        ('"0x1600:1" = 1', "commands the motor or the bus"),
        ('"0x6072" = 1000', "is set by limits.max_torque: use that key"),
        ('"x" = 1', 'must be an index, "0x3001"'),
        ('"0x2001" = -1', "a negative number needs its type"),
        ('"0x2001" = { value = 70000, type = "u16" }', r"must lie in \[0, 65535\]"),
        ('"0x2001" = 1.5', "must be a whole number"),
        ('"0x2001" = { value = 1, kind = "u16" }', "must be value, type or why"),
    ],
)
def test_objects_of_a_profile_are_numbers_that_command_nothing(
    tmp_path: Path, line: str, message: str
) -> None:
    with pytest.raises(drives.ProfileError, match=message):
        written(tmp_path, f"[objects]\n{line}\n")


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('without = ["torque.mode"]', "every drive needs it"),
        ('without = ["heartbeat.consumer"]', "every drive needs it"),
        ('without = ["limits.max_torqe"]', "did you mean"),
        ('without = "all"', "must be a list of keys"),
        ('without = ["limits.max_torque"]\n[limits]\nrated_torque = 1.0\nmax_torque = 1.0',
         "without names every limit"),
    ],
)  # fmt: skip
def test_what_a_drive_may_lack_is_checked(tmp_path: Path, line: str, message: str) -> None:
    with pytest.raises(drives.ProfileError, match=message):
        written(tmp_path, f"{line}\n")


def test_a_raw_number_is_not_shown_in_the_unit_of_the_standard() -> None:
    """An EPOS4 has its rated torque (0x6076) in 1e-6 N m, not in mN m: 52993 are 53 mN m."""
    (node,) = drives.load("maxon-epos4", nodes=[5]).nodes
    with drives.DriveBus(SimulatedBus(_core.SimulatedDrive(node=5, sheet=dictionary(node)))) as bus:
        rows = {c.object.name: c.row() for c in drives.plan(bus.drive(5), node).changes}
    assert (rows["rated_torque"]["wanted"], rows["rated_torque"]["unit"]) == (52993, "")
    assert "1e-6 N m" in rows["rated_torque"]["why"]
    assert rows["sync_period"]["unit"] == "us"


def test_a_negative_object_is_written_as_its_type(tmp_path: Path) -> None:
    network = written(
        tmp_path, '[objects]\n"0x2001" = { value = -5, type = "i16", why = "offset" }\n'
    )
    (own,) = network.nodes[0].profile.objects
    assert (own.value, own.object.kind, own.why) == (-5, "i16", "offset")
