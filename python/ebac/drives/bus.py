"""One CAN bus with drives on it: open, look who is there, close."""

from __future__ import annotations

import errno
import logging
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from ebac._util.arguments import whole
from ebac._util.wrong_calls import plain_constructor
from ebac.drives.bus_monitor import BusMonitor
from ebac.drives.data_sheet import Sheet
from ebac.drives.errors import BusError, NoCan

if TYPE_CHECKING:
    import can

    from ebac.drives.drive import Drive

#: How long an SDO answer may take [s]. Drives answer within a few ms; a busy laptop does not.
TIMEOUT = 0.3
#: How long a master counts as being there after its last frame [s]: the slowest SYNC of a profile comes every second.
RECENT = 1.1
#: SDO request for the device type (0x1000), which every node has.
READ_DEVICE_TYPE = bytes([0x40, 0x00, 0x10, 0, 0, 0, 0, 0])
#: canopen logs each aborted transfer, which is an exception here: shown only to who sets up logging.
_UNHEARD = logging.NullHandler()


@plain_constructor
class DriveBus:
    """A CAN bus, by python-can, and the drives on it. A context manager that closes what it opened.

    Parameters
    ----------
    bus : can.BusABC
        An open bus of python-can; it is shut down on close.

    Examples
    --------
    >>> with DriveBus.open(interface="socketcan", channel="can0") as bus:  # doctest: +SKIP
    ...     print(bus.drive(1).state)
    """

    def __init__(self, bus: can.BusABC) -> None:
        import canopen

        logging.getLogger("canopen").addHandler(_UNHEARD)
        self.monitor = BusMonitor()
        self.network = canopen.Network(bus)
        self.network.NOTIFIER_CYCLE = 0.01  # s; closing waits for it
        self._drives: dict[int, Drive] = {}
        self.network.connect()
        assert self.network.notifier is not None
        self.network.notifier.add_listener(self.monitor)

    @classmethod
    def open(
        cls,
        *,
        interface: str | None = None,
        channel: str | None = None,
        bitrate: int | None = None,
    ) -> Self:
        """Open a bus; what is not given comes from python-can's own configuration.

        Parameters
        ----------
        interface : str, optional
            Of python-can: "socketcan", "ebac" (simulated joystick), "kvaser", ...
        channel : str, optional
            "can0", "joystick", ...
        bitrate : int, optional
            [bit/s]; SocketCAN takes it from `ip link`, not from here.

        Raises
        ------
        BusError
            When it cannot be opened; the message contains the remedy.
        """
        return cls(open_bus(interface=interface, channel=channel, bitrate=bitrate))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the bus. Drives stay as they are."""
        import can

        with suppress(
            can.CanError, OSError
        ):  # an interface that went down, which was reported when it was used
            self.network.disconnect()

    def drive(
        self, node: int, *, eds: str | Path | Sheet | None = None, timeout: float | None = None
    ) -> Drive:
        """Return the drive of that node; the same object every time, so that its lock is one.

        Data sheet and timeout of a later call act on that object, for all who have it.

        Parameters
        ----------
        node : int
            Node id, 1 to 127.
        eds : str, Path or Sheet, optional
            Electronic data sheet, for names this package does not know; default: the one it has, if any.
        timeout : float, optional
            How long an SDO answer may take [s], 0.001 to 60; default: as it is, 0.3 at first.

        Raises
        ------
        TypeError
            For a node id that is no whole number.
        ValueError
            For a node id or a timeout out of range, and for a data sheet that is none.
        """
        from ebac.drives.drive import Drive
        from ebac.drives.eds import read_eds

        node = whole("node", node)
        if not 1 <= node <= 127:
            raise ValueError(f"node = {node}: must lie in [1, 127]")
        sheet = eds if eds is None or isinstance(eds, Sheet) else read_eds(eds)
        drive = self._drives.get(node)
        if drive is None:
            first = TIMEOUT if timeout is None else timeout
            drive = self._drives[node] = Drive(self, node, eds=sheet, timeout=first)
        elif timeout is not None:
            drive.sdo.timeout = timeout
        drive.sheet = sheet or drive.sheet
        return drive

    def check_alone(self, nodes: Sequence[int], *, seconds: float = 0.05) -> None:
        """Listen, and refuse a bus on which somebody else commands these nodes.

        Parameters
        ----------
        nodes : sequence of int
            Ids of the drives.
        seconds : float
            How long to listen [s]. What came in the second before counts as well.

        Raises
        ------
        BusError
            When another node sends SYNC, or torques to one of them.
        """
        start = time.monotonic() - RECENT
        time.sleep(seconds)
        if found := self.monitor.commanding(nodes, start):
            raise BusError(
                f"somebody else commands on this bus: {', '.join(found)}. End the other loop or master first; two of "
                "them would take turns at the same motors"
            )

    def scan(self, *, seconds: float = 0.3, nodes: range = range(1, 128)) -> list[int]:
        """Return the ids of the nodes that answer an SDO or send a heartbeat.

        Parameters
        ----------
        seconds : float
            How long to listen after the last request [s].
        nodes : range
            Ids to ask.

        Raises
        ------
        BusError
            When the bus takes no frame.
        """
        import can

        for node in nodes:
            try:
                self.network.send_message(0x600 + node, READ_DEVICE_TYPE)
            except (can.CanError, OSError, RuntimeError) as error:
                self.monitor.check_receiving(f"asking node {node}")
                raise BusError(
                    f"asking node {node}: the bus took no frame ({error}); a bus with nobody else on "
                    "it acknowledges nothing: are the drives powered and wired?"
                ) from error
            time.sleep(0.001)  # a request is 0.13 ms at 1 Mbit/s; a send queue holds only ten
        time.sleep(seconds)
        self.monitor.check_receiving("asking who is there")
        return [node for node in self.monitor.nodes(asked=True) if node in nodes]


def open_bus(
    *, interface: str | None = None, channel: str | None = None, bitrate: int | None = None
) -> can.BusABC:
    """Open a bus of python-can; parameters and errors are those of `DriveBus.open`."""
    import can

    chosen: dict[str, Any] = {"interface": interface, "channel": channel, "bitrate": bitrate}
    given = {name: value for name, value in chosen.items() if value is not None}
    try:
        return can.Bus(**given)
    except Exception as error:
        # Without its frames: they keep a bus half made, which python-can reports when it is freed at last.
        raise _in_words(error, interface, channel) from error.with_traceback(None)


def _in_words(error: Exception, interface: str | None, channel: str | None) -> BusError:
    """Return what python-can raised while it opened a bus as one error with a remedy."""
    import can

    asked = f"interface {interface or 'from python-can'}, channel {channel or 'from python-can'}"
    if isinstance(error, can.CanInterfaceNotImplementedError):
        if interface is None:
            return BusError(
                "no CAN interface is chosen: give --interface and --channel, or set CAN_INTERFACE and "
                "CAN_CHANNEL, or write them to ~/.canrc (python-can's configuration)"
            )
        known = ", ".join(sorted(can.VALID_INTERFACES))
        return BusError(f"interface {interface!r} is not usable: {error}. There are: {known}")
    if isinstance(error, OSError):
        kind = NoCan if error.errno in (errno.EAFNOSUPPORT, errno.ENODEV) else BusError
        return kind(f"{asked}: {error.strerror or error}; {_remedy(error.errno)}")
    if isinstance(error, (can.CanError, ValueError, TypeError, NotImplementedError)):
        group = "; its channel is a multicast address such as 239.74.163.2"
        return BusError(
            f"{asked}: cannot be opened ({error}){group * (interface == 'udp_multicast')}"
        )
    return BusError(  # what a maker's library raises that is missing
        f"{asked}: its driver is missing or does not load ({type(error).__name__}: {error}); install the maker's "
        "driver and its library for Python, or choose another interface"
    )


def _remedy(number: int | None) -> str:
    if number == errno.EAFNOSUPPORT:
        return "this kernel has no SocketCAN: load its module (`sudo modprobe can_raw`)"
    if number == errno.ENODEV:
        return "there is no such interface: `ip link` lists them"
    if number == errno.ENETDOWN:
        return (
            "bring it up: `sudo ip link set can0 up type can bitrate 1000000` (with your interface)"
        )
    if number in (errno.EACCES, errno.EPERM):
        return "this user may not use it: see the rights of the device"
    return "see the manual of the interface"
