"""The object dictionary with which a drive of a network is simulated."""

from __future__ import annotations

from dataclasses import replace

from ebac._core import SimulatedDrive
from ebac.drives.data_sheet import Row, Sheet, SheetEntry
from ebac.drives.eds import parse_eds
from ebac.drives.network import Node
from ebac.drives.objects import Object
from ebac.drives.settings import groups

#: Where a drive has its maker's number.
_VENDOR = (0x1018, 1)
#: Where makers put objects of their own; those of the simulated drive alone (`ebac drive inject`) lie above.
_OF_COPLEY = range(0x2000, 0x5F00)


def dictionary(node: Node) -> list[Row]:
    """Return the rows for the simulated drive of a node; none for the simulated drive's own dictionary.

    They are those of the node's data sheet. Without one a drive is simulated that the node's profile fits: the
    simulated drive's own objects without those that the profile says are absent, and with all in its `[objects]`. Of a
    maker that the profile names it has the number, and of objects of makers no others than the profile sets.
    """
    if node.sheet is not None:
        return node.sheet.rows(node.id)
    profile = node.profile
    if not (profile.objects or profile.without or profile.vendor):
        return []
    own = parse_eds(SimulatedDrive(node=node.id).eds()).entries
    absent = {obj.key for obj, _ in profile.absent()}
    # No defaults: the drive has its own, which follow from its motor.
    entries = {key: replace(one, default=None) for key, one in own.items() if key not in absent}
    if profile.vendor:
        entries = _of_vendor(entries, profile.vendor, _set_by(node))
    for setting in profile.objects:
        entries[setting.object.key] = _writable(setting.object)
    return Sheet(name=profile.name, entries=entries).rows(node.id)


def _set_by(node: Node) -> set[tuple[int, int]]:
    """Return where the objects are that a profile sets."""
    return {one.object.key for group in groups(node.profile, node.id) for one in group.settings}


def _of_vendor(
    entries: dict[tuple[int, int], SheetEntry], vendor: int, wanted: set[tuple[int, int]]
) -> dict[tuple[int, int], SheetEntry]:
    """Return the objects of a drive by a maker: without those of Copley, which the simulated drive has of its own."""
    indices = {index for index, _ in wanted}
    kept = {
        (index, sub): one
        for (index, sub), one in entries.items()
        if index not in _OF_COPLEY or (index, sub) in wanted or (sub == 0 and index in indices)
    }
    return {**kept, _VENDOR: replace(kept[_VENDOR], default=vendor)}


def _writable(obj: Object) -> SheetEntry:
    return SheetEntry(
        index=obj.index, sub=obj.sub, name=obj.name, kind=obj.kind, size=obj.bits // 8
    )
