"""One node of a bus: its objects by name, its NMT commands."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ebac._util.arguments import unknown
from ebac.drives.data_sheet import Sheet
from ebac.drives.eds import read_eds
from ebac.drives.errors import BusError, DriveError, Refused, WrongAnswer
from ebac.drives.objects import Object, find, known
from ebac.drives.sdo import Sdo

if TYPE_CHECKING:
    from ebac.drives.bus import DriveBus

#: NMT commands (CiA 301).
NMT = {"start": 0x01, "stop": 0x02, "pre-operational": 0x80, "reset": 0x81, "reset-comm": 0x82}


class BusNode:
    """A CANopen node on a bus. Threads may share it: one SDO is under way at a time.

    Parameters
    ----------
    bus : DriveBus
        Where it is.
    node : int
        Node id, 1 to 127.
    eds : str, Path or Sheet, optional
        Electronic data sheet, for names this package does not know.
    timeout : float
        How long an SDO answer may take [s].
    """

    def __init__(
        self, bus: DriveBus, node: int, *, eds: str | Path | Sheet | None = None, timeout: float
    ) -> None:
        import canopen

        self.sheet = eds if eds is None or isinstance(eds, Sheet) else read_eds(eds)
        self._remote = canopen.RemoteNode(node, canopen.import_od(None, node))
        bus.network.add_node(self._remote)
        self.bus = bus
        self.node = node
        self.sdo = Sdo(self._remote.sdo, node, bus.monitor, timeout)

    def __repr__(self) -> str:
        return f"{type(self).__name__}(node={self.node})"

    def object(self, what: str | int | tuple[int, int] | Object) -> Object:
        """Return an object by name, index, or (index, sub-index); a name that is not known here by the EDS.

        Raises
        ------
        KeyError
            For an unknown name; the message suggests the nearest.
        """
        if isinstance(what, str) and what not in known():
            entry = self._sheet(what)
            if entry is not None:
                return entry
        return find(what)

    def _sheet(self, name: str) -> Object | None:
        """Return what the electronic data sheet has by that name: "Motor data.Torque constant"."""
        entry = None if self.sheet is None else self.sheet.find(name)
        if entry is None:
            return None
        return Object(name=name, index=entry.index, sub=entry.sub, kind=entry.kind)

    def check_sheet(self) -> None:
        """Compare the maker of the drive (0x1018) with that of its electronic data sheet, where one was given.

        Raises
        ------
        DriveError
            When the sheet is another maker's.
        """
        if self.sheet is None or self.sheet.vendor == 0:
            return
        vendor = self.look("vendor_id")
        if isinstance(vendor, int) and vendor not in (0, self.sheet.vendor):
            raise DriveError(
                f"node {self.node} is by vendor 0x{vendor:X}, and {self.sheet.name} is for vendor "
                f"0x{self.sheet.vendor:X} ({self.sheet.vendor_name}): take the data sheet of this drive, or none",
                node=self.node,
            )

    def read(self, what: str | int | tuple[int, int] | Object) -> int | str:
        """Read an object in its own unit (`objects.find(what).unit`).

        Raises
        ------
        NoAnswer, Refused, WrongAnswer, BusError
            When the drive gives no value.
        """
        obj = self.object(what)
        return obj.decode(self.sdo.upload(obj))

    def number(self, what: str | int | tuple[int, int] | Object) -> int:
        """Read an object that is a number. Raises as `read`."""
        value = self.read(what)
        if isinstance(value, str):
            raise WrongAnswer(
                f"node {self.node}: {self.object(what)} is text: {value!r}", node=self.node
            )
        return value

    def look(self, what: str | int | tuple[int, int] | Object) -> int | str | None:
        """Read an object, None where the drive has none. Raises as `read` otherwise."""
        try:
            return self.read(what)
        except Refused as error:
            if error.absent:
                return None
            raise

    def write(self, what: str | int | tuple[int, int] | Object, value: int) -> None:
        """Write an object in its own unit.

        Raises
        ------
        TypeError
            For a value that is no whole number.
        ValueError
            When the value does not fit the object.
        NoAnswer, Refused, WrongAnswer, BusError
            When the drive does not take it.
        """
        obj = self.object(what)
        self.sdo.download(obj, obj.encode(value))

    def nmt(self, command: str) -> None:
        """Send an NMT command to this node: start, stop, pre-operational, reset, reset-comm."""
        import can

        if command not in NMT:
            raise ValueError(unknown(f"NMT command {command!r}", command, NMT))
        try:
            self.bus.network.send_message(0, bytes([NMT[command], self.node]))
        except (can.CanError, OSError, RuntimeError) as error:
            self.bus.monitor.check_receiving(f"node {self.node}, NMT {command}")
            raise BusError(
                f"node {self.node}: NMT {command} was not sent, the bus took no frame ({error})",
                node=self.node,
            ) from error
