"""The options of `ebac drive`: which bus, which nodes, which profile."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import typer

from ebac._util.arguments import unknown
from ebac.cli import doubtful, interrupts, output
from ebac.cli.drive import without_can

if TYPE_CHECKING:
    from ebac.drives import Drive, DriveBus, Network, Sheet

_BUS = "Bus"


def profiles(incomplete: str) -> list[str]:
    """Return the names that come with ebac and begin so."""
    from ebac.drives.profile import builtin

    return [name for name in builtin() if name.startswith(incomplete)]


Bitrate: TypeAlias = Annotated[
    int | None,
    typer.Option(
        help="Bit rate [bit/s]. SocketCAN has its own, set with `ip link`.",
        show_default="python-can's configuration",
        min=1000,
        max=8_000_000,
        rich_help_panel=_BUS,
    ),
]


SheetFile: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        help="Electronic data sheet of the drives (EDS or DCF, CiA 306), in any encoding.",
        show_default=False,
        rich_help_panel=_BUS,
    ),
]


ConfigurationFile: TypeAlias = Annotated[
    Path,
    typer.Argument(help="Configuration in TOML, as `ebac demo joystick` writes it."),
]


Simulated: TypeAlias = Annotated[
    bool, typer.Option("--simulated", help="With simulated drives, device and hand.")
]


@dataclass(frozen=True, kw_only=True)
class BusOptions:
    """Which bus, and how long an answer may take."""

    interface: Annotated[
        str | None,
        typer.Option(
            help="Interface of python-can: socketcan, ebac (simulated joystick), kvaser, ...",
            show_default="python-can's configuration",
            rich_help_panel=_BUS,
        ),
    ] = None
    channel: Annotated[
        str | None,
        typer.Option(
            help="Channel of the interface: can0, joystick, ...",
            show_default="python-can's configuration",
            rich_help_panel=_BUS,
        ),
    ] = None
    bitrate: Bitrate = None
    eds: SheetFile = None
    timeout: Annotated[
        float,
        typer.Option(
            help="How long an answer of a drive may take [s].",
            min=0.001,
            max=60,
            rich_help_panel=_BUS,
        ),
    ] = 0.3


Nodes: TypeAlias = Annotated[
    list[int] | None,
    typer.Option(
        "--node",
        "-n",
        help="Node id of a drive, 1 to 127; several separated by commas.",
        show_default="every drive that answers",
        min=1,
        max=127,
    ),
]
ProfileNodes: TypeAlias = Annotated[
    list[int] | None,
    typer.Option(
        "--node",
        "-n",
        help="Node id, 1 to 127; several separated by commas. A profile that is not a network file needs it.",
        show_default="all of the network file",
        min=1,
        max=127,
    ),
]
ProfileName: TypeAlias = Annotated[
    str,
    typer.Argument(
        help="A profile or network file, or the name of one that comes with ebac: "
        "joystick, copley-accelnet, generic-cia402, ...",
        autocompletion=profiles,
    ),
]
Yes: TypeAlias = Annotated[bool, typer.Option("--yes", "-y", help="Do not ask for confirmation.")]
Store: TypeAlias = Annotated[
    bool, typer.Option("--store", help="Store the settings in the drive's flash memory (0x1010).")
]
BackupFolder: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--backup",
        help="Folder of the backups.",
        show_default="~/.local/state/ebac/drives",
    ),
]


@contextmanager
def reporting() -> Iterator[None]:
    """Turn what goes wrong with a drive, or with a profile, into the end of the command."""
    from ebac.drives import DriveError

    # canopen logs beside its exceptions; what it has to say stands in ours.
    with output.refusing(), _silent("can"), _silent("canopen"):
        try:
            yield
        except DriveError as error:
            notes = getattr(error, "__notes__", [])
            said = ". ".join([str(error), *notes])
            output.fail(f"{said}{without_can.remedy(error)}", code=output.FAILED)
        except KeyboardInterrupt as error:
            notes = getattr(error, "__notes__", [])
            if not notes:
                raise
            output.fail(". ".join(notes), code=interrupts.exit_code())


@contextmanager
def _silent(name: str) -> Iterator[None]:
    """Let a logger report only what is critical."""
    import logging

    logger = logging.getLogger(name)
    before = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(before)


def known_interface(name: str | None) -> None:
    """Raise ValueError for an interface that python-can does not have."""
    from can import VALID_INTERFACES

    if name is not None and name not in VALID_INTERFACES:
        raise ValueError(unknown(f"--interface {name}", name, sorted(VALID_INTERFACES)))


@contextmanager
def opened(where: BusOptions) -> Iterator[DriveBus]:
    """Give an open bus; what goes wrong on it ends the command."""
    from ebac.drives import DriveBus
    from ebac.drives.who_answers import naming_who_answers

    with output.refusing():
        known_interface(where.interface)
        sheet_of(where)
    with (
        reporting(),
        DriveBus.open(
            interface=where.interface, channel=where.channel, bitrate=where.bitrate
        ) as bus,
    ):
        _refuse_empty(bus)
        with naming_who_answers(bus):
            yield bus


def _refuse_empty(bus: DriveBus) -> None:
    """Refuse a bus inside this process on which nothing can answer: no other program can reach it."""
    from ebac.can.channels import without_nodes
    from ebac.can.interface import EbacBus

    ours = bus.network.bus
    if isinstance(ours, EbacBus) and (wrong := without_nodes(ours.channel)):
        raise ValueError(f"--channel: {wrong}")


def sheet_of(where: BusOptions) -> Sheet | None:
    """Return the electronic data sheet of --eds; None where none was given."""
    from ebac.drives import read_eds

    return None if where.eds is None else read_eds(where.eds)


def drives(bus: DriveBus, nodes: list[int] | None, where: BusOptions) -> list[Drive]:
    """Return the drives of the nodes given, or every CiA 402 drive that answers."""
    from ebac.drives import DriveError

    sheet = sheet_of(where)
    if nodes:
        return [bus.drive(n, eds=sheet, timeout=where.timeout) for n in dict.fromkeys(nodes)]
    answering = bus.scan(seconds=where.timeout)
    found = [bus.drive(node, eds=sheet, timeout=where.timeout) for node in answering]
    chosen = [drive for drive in found if is_drive(drive)]
    if not chosen:
        raise DriveError(
            "no drive answers on this bus: check power, bit rate and termination, or give --node"
        )
    return chosen


def checked(bus: DriveBus, node: int, where: BusOptions, own: Sheet | None = None) -> Drive:
    """Return one drive, after a look whether the data sheet, of --eds or else its own, is its maker's."""
    drive = bus.drive(node, eds=sheet_of(where) or own, timeout=where.timeout)
    drive.check_sheet()
    return drive


def is_drive(drive: Drive) -> bool:
    """Return whether a node is a CiA 402 drive (0x1000)."""
    from ebac.drives import DriveError

    try:
        return drive.number("device_type") & 0xFFFF == 402
    except DriveError:
        return False


def sure(question: str, yes: bool) -> None:
    """Ask, unless --yes is given; where nobody can be asked, refuse."""
    if yes:
        return
    if sys.stdin is None or not sys.stdin.isatty():
        output.fail(f"{question} Nobody is here to ask: add --yes")
    if not typer.confirm(question, err=True):
        output.fail("nothing was done", code=output.FAILED)


def network_of(profile: str, node: list[int] | None, where: BusOptions) -> Network:
    """Return the drives of a profile or network file; one that cannot be right ends the command."""
    from ebac import drives as library

    with reporting():
        network = library.load(profile, nodes=node or (), bitrate=where.bitrate)
        network.check_load()
        library.check_stall(network)
        if (sheet := sheet_of(where)) is not None:
            library.check_sheet(network, sheet)
    doubtful.note_profiles(network)
    return network


def about(network: Network) -> dict[str, Any]:
    """Return the JSON document of a network."""
    load = network.bus_load()
    return {
        "profile": network.name,
        "bitrate_bit_per_s": load.bitrate,
        "bus_load_share": load.share,
    }
