"""Take a simulated drive with the dictionary of a data sheet through a profile."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from ebac import drives
from ebac._core import SimulatedDrive

sys.path.insert(0, str(Path(__file__).parent.parent / "buses"))
from simulated_bus import SimulatedBus


def drive_through(sheet: drives.Sheet, network: drives.Network) -> int:
    """Plan, apply, verify, enable, disable and restore on node 1; return the number of writes.

    Raises
    ------
    DriveError
        When a step fails.
    """
    node = network.nodes[0]
    simulated = SimulatedDrive(node=node.id, sheet=sheet.rows(node.id))
    with (
        tempfile.TemporaryDirectory() as folder,
        drives.DriveBus(SimulatedBus(simulated, per_frame=1e-3)) as bus,
    ):
        drive = bus.drive(node.id, eds=sheet)
        drive.check_sheet()
        backups = drives.Backups(Path(folder))
        before = {
            key: drive.look(key) for key in ((0x6060, 0), (0x1600, 0)) if _readable(sheet, key)
        }
        done = drives.apply(drive, node, backups=backups)
        drives.verify(drive, node)
        drive.enable(mode=int(node.profile.values["torque.mode"] == "profile torque") * -6 + 10)
        drive.disable()
        drives.restore(drive, backups=backups)
        after = {key: drive.look(key) for key in before}
        assert after == before, f"restore: {before} became {after}"
    return len(done.written)


def _readable(sheet: drives.Sheet, key: tuple[int, int]) -> bool:
    return key in sheet.entries and sheet.entries[key].access != "wo"
