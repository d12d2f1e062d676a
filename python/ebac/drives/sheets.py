"""Whether the profiles of a network fit the data sheets of its drives."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac.drives.data_sheet import Sheet
from ebac.drives.errors import ProfileError, lacks, says_absent
from ebac.drives.objects import find
from ebac.drives.settings import groups

if TYPE_CHECKING:
    from ebac.drives.network import Network


def check_sheet(network: Network, sheet: Sheet | None = None) -> None:
    """Refuse profiles that a drive with this electronic data sheet cannot take, before anything is on a bus.

    Parameters
    ----------
    network : Network
        The drives with their profiles.
    sheet : Sheet, optional
        Data sheet of all of them; default: that of each node, and none is checked that has none.

    Raises
    ------
    ProfileError
        For the first node whose drive lacks objects, or cannot map them; all of them are listed.
    """
    for node in network.nodes:
        own = sheet or node.sheet
        if own is None:
            continue
        settings = [one for group in groups(node.profile, node.id) for one in group.settings]
        lacking = [
            (one.object, one.key)
            for one in settings
            if not one.optional and one.object.key not in own.entries
        ]
        mapped = [(find(name), f"pdo.{p.name}") for p in node.profile.pdos for name in p.objects]
        lacking += [pair for pair in mapped if pair[0].key not in own.entries]
        if lacking:
            raise ProfileError(f"{network.name}, node {node.id}: {own.name} {lacks(lacking)}")
        for obj, key in node.profile.absent():
            if obj.key in own.entries:
                raise ProfileError(
                    f"{network.name}, node {node.id}: {own.name} {says_absent(obj, key)}"
                )
        fixed = [
            f"{obj.where} {obj.name} ({key})"
            for obj, key in mapped
            if not own.entries[obj.key].mappable
        ]
        if fixed:
            raise ProfileError(
                f"{network.name}, node {node.id}: {own.name} lets no PDO carry {', '.join(fixed)}: map another object"
            )
