"""The object dictionary with which a drive of a network is simulated."""

from __future__ import annotations

from dataclasses import replace

from ebac._core import SimulatedDrive
from ebac.drives.data_sheet import Row, Sheet, SheetEntry
from ebac.drives.eds import parse_eds
from ebac.drives.network import Node
from ebac.drives.objects import Object


def dictionary(node: Node) -> list[Row]:
    """Return the rows for the simulated drive of a node; none for the simulated drive's own dictionary.

    They are those of the node's data sheet. Without one a drive is simulated that the node's profile fits: the
    simulated drive's own objects without those that the profile says are absent, and with all in its `[objects]`.
    """
    if node.sheet is not None:
        return node.sheet.rows(node.id)
    profile = node.profile
    if not (profile.objects or profile.without):
        return []
    own = parse_eds(SimulatedDrive(node=node.id).eds()).entries
    absent = {obj.key for obj, _ in profile.absent()}
    # No defaults: the drive has its own, which follow from its motor.
    entries = {key: replace(one, default=None) for key, one in own.items() if key not in absent}
    for setting in profile.objects:
        entries[setting.object.key] = _writable(setting.object)
    return Sheet(name=profile.name, entries=entries).rows(node.id)


def _writable(obj: Object) -> SheetEntry:
    return SheetEntry(
        index=obj.index, sub=obj.sub, name=obj.name, kind=obj.kind, size=obj.bits // 8
    )
