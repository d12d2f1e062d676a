"""CANopen drives (CiA 301, CiA 402): look at them, set them up, take it back.

Works on a laptop beside the machine; process data at 1 kHz belong to the C++ loop, not here.

A first look::

    from ebac import drives

    with drives.DriveBus.open(interface="ebac", channel="joystick") as bus:  # simulated drives
        for node in drives.load("joystick").nodes:
            for change in drives.plan(bus.drive(node.id), node).changes:
                print(change)
"""

from ebac._core import TimedBus
from ebac.drives.apply import Applied, apply, restore, verify
from ebac.drives.backup import Backup, Backups
from ebac.drives.bus import DriveBus
from ebac.drives.data_sheet import Sheet, SheetEntry
from ebac.drives.drive import Drive
from ebac.drives.eds import parse_eds, read_eds
from ebac.drives.errors import (
    BusError,
    DriveError,
    DriveFault,
    Missing,
    NoAnswer,
    NotApplied,
    NotVerified,
    ProfileError,
    Refused,
    WrongAnswer,
    WrongState,
)
from ebac.drives.frame_length import exact_bits, frame_bits
from ebac.drives.load import BusLoad, Traffic, bus_load
from ebac.drives.network import Network, Node, load
from ebac.drives.objects import Object, find
from ebac.drives.pdo import Pdo
from ebac.drives.plan import Change, Plan, plan
from ebac.drives.profile import Profile, builtin
from ebac.drives.setting import Setting
from ebac.drives.sheets import check_sheet
from ebac.drives.simulate import inject
from ebac.drives.stall import check_pace, check_stall, hold_time
from ebac.drives.state import TRANSITIONS, Command, Controlword, State, Statusword, path
from ebac.drives.timing import BusTiming, bus_timing

__all__ = [
    "TRANSITIONS",
    "Applied",
    "Backup",
    "Backups",
    "BusError",
    "BusLoad",
    "BusTiming",
    "Change",
    "Command",
    "Controlword",
    "Drive",
    "DriveBus",
    "DriveError",
    "DriveFault",
    "Missing",
    "Network",
    "NoAnswer",
    "Node",
    "NotApplied",
    "NotVerified",
    "Object",
    "Pdo",
    "Plan",
    "Profile",
    "ProfileError",
    "Refused",
    "Setting",
    "Sheet",
    "SheetEntry",
    "State",
    "Statusword",
    "TimedBus",
    "Traffic",
    "WrongAnswer",
    "WrongState",
    "apply",
    "builtin",
    "bus_load",
    "bus_timing",
    "check_pace",
    "check_sheet",
    "check_stall",
    "exact_bits",
    "find",
    "frame_bits",
    "hold_time",
    "inject",
    "load",
    "parse_eds",
    "path",
    "plan",
    "read_eds",
    "restore",
    "verify",
]


def __dir__() -> list[str]:
    return __all__
