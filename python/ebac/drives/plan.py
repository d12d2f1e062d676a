"""The plan: what would change on a drive, before anything does."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from ebac.drives.aborts import WRITE_ONLY
from ebac.drives.drive import Drive
from ebac.drives.errors import DriveError, Missing, Refused, says_absent
from ebac.drives.network import Node
from ebac.drives.objects import ENTRIES, Object, find, mapped
from ebac.drives.settings import Group, Write, groups, writes

#: Makers by their number (0x1018:1), and the profiles for their drives.
_MAKERS: dict[object, str] = {
    0x9A: "Elmo: see the profile elmo-gold",
    0xAB: "Copley: see the profiles copley-accelnet, copley-xenus and copley-guarded",
    0xFB: "maxon: see the profile maxon-epos4",
    0x286: "Trinamic: see the profile trinamic-tmcm",
}


@dataclass(frozen=True, kw_only=True)
class Change:
    """One object that does not hold what is wanted.

    Parameters
    ----------
    node : int
        Node id.
    object : Object
        Which.
    now, wanted : int
        Raw numbers.
    why : str
        For people.
    """

    node: int
    object: Object
    now: int
    wanted: int
    why: str

    @property
    def unit(self) -> str:
        """Unit of both raw numbers; empty for a pure one, and for bits."""
        return "" if self.object.hexadecimal else self.object.unit

    @property
    def shown(self) -> tuple[str, str]:
        """What the drive holds, and what is wanted with its unit, as people read them: "0", "1000 us"."""
        return self.show(self.now), f"{self.show(self.wanted)} {self.unit}".rstrip()

    def __str__(self) -> str:
        now, wanted = self.shown
        return f"{self.object}: {now} -> {wanted} ({self.why})"

    def row(self) -> dict[str, Any]:
        """Return it as a plain row."""
        return {
            "node": self.node,
            "object": self.object.where,
            "name": self.object.name,
            "now": self.now,
            "wanted": self.wanted,
            "unit": self.unit,
            "why": self.why,
        }

    def show(self, value: int) -> str:
        """Return one of its numbers as people read it, without unit."""
        if "_entry" in self.object.name and value:
            return f"{mapped(value)} ({value & 0xFF} bit)"
        return self.object.show(value).removesuffix(self.object.unit).rstrip()


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What would change on one drive, and what it holds now.

    Parameters
    ----------
    node : Node
        Which, with its profile.
    groups : tuple of Group
        All that is wanted.
    held : dict
        What the drive holds: bytes by (index, sub-index).
    changes : tuple of Change
        What differs.
    """

    node: Node
    groups: tuple[Group, ...]
    held: dict[tuple[int, int], bytes]
    changes: tuple[Change, ...]

    def writes(self) -> list[Write]:
        """Return the SDO downloads that make the changes, in order."""
        return [write for group in self.groups for write in writes(group, self.held)]


def plan(drive: Drive, node: Node) -> Plan:
    """Ask a drive for all a profile sets, and return what would change. Nothing is written.

    Parameters
    ----------
    drive : Drive
        Whom to ask.
    node : Node
        What is wanted; its id must be that of the drive.

    Raises
    ------
    Missing
        When the drive lacks objects the profile sets; all of them are listed.
    DriveError
        When it has one that the profile's `without` says it lacks.
    NoAnswer, WrongAnswer, BusError
        When the drive gives no value.
    """
    if drive.node != node.id:
        raise ValueError(f"node = {node.id}: the drive is node {drive.node}")
    wanted = tuple(groups(node.profile, node.id))
    held = read_held(drive, wanted)
    for obj, key in node.profile.absent():
        if drive.look(obj) is not None:
            raise DriveError(f"node {drive.node} {says_absent(obj, key)}", node=drive.node)
    return Plan(
        node=node, groups=wanted, held=held, changes=tuple(differences(drive.node, wanted, held))
    )


def read_held(drive: Drive, wanted: Iterable[Group]) -> dict[tuple[int, int], bytes]:
    """Return what a drive holds of all groups; of a PDO that is remapped, its whole mapping.

    Raises
    ------
    Missing
        When the drive lacks objects that are not optional.
    """
    held: dict[tuple[int, int], bytes] = {}
    lacking: list[tuple[Object, str, int]] = []
    for group in wanted:
        for setting in group.settings:
            try:
                held[setting.object.key] = _look(drive, setting.object)
            except Refused as error:
                if not error.absent:
                    raise
                if not setting.optional:
                    lacking.append((setting.object, setting.key, error.code))
        if group.pdo and len(group.settings) > 1 and not lacking:
            held |= _other_entries(drive, group, held)
    if lacking:
        missing = Missing(drive.node, lacking)
        with suppress(DriveError):  # what is missing is more than who made it
            vendor = drive.look("vendor_id")
            if vendor in _MAKERS:
                missing.add_note(f"Its maker is {_MAKERS[vendor]}")
        raise missing
    return held


def differences(
    node: int, wanted: Iterable[Group], held: dict[tuple[int, int], bytes]
) -> list[Change]:
    """Return the settings a drive does not hold."""
    found = []
    for group in wanted:
        for one in group.settings:
            data = held.get(one.object.key)
            if data is None or one.holds(data):
                continue
            now = one.object.decode(data)
            assert isinstance(now, int)
            found.append(
                Change(node=node, object=one.object, now=now, wanted=one.wanted(data), why=one.why)
            )
    return found


def _look(drive: Drive, obj: Object) -> bytes:
    """Read an object; the mode of a drive that lets nobody read it (0x6060) is the mode that acts (0x6061)."""
    try:
        return drive.sdo.upload(obj)
    except Refused as error:
        if obj.name == "mode" and error.code == WRITE_ONLY:
            return drive.sdo.upload(find("mode_display"))
        raise


def _other_entries(
    drive: Drive, group: Group, held: dict[tuple[int, int], bytes]
) -> dict[tuple[int, int], bytes]:
    """Return the entries of a mapping beyond those wanted: to put them back one day."""
    (count,) = [one.object for one in group.settings if one.object.name.endswith("_count")]
    used = int.from_bytes(held[count.key], "little")
    found = {}
    for sub in range(1, min(used, ENTRIES) + 1):
        if (count.index, sub) not in held:
            found[count.index, sub] = drive.sdo.upload(drive.object((count.index, sub)))
    return found
