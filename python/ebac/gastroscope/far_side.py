"""The other end of a network as the world of a loop on drives: what happens at the link, in words."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from ebac import _core
from ebac._core import Fault
from ebac._core import TeleopPacket as Packet
from ebac._util.headings import with_units
from ebac.worlds.engines import ForeignWorld

#: Names of the four axes, with their units and those of their loads.
AXES = (
    ("insertion", "m", "N"),
    ("rotation", "rad", "N_m"),
    ("bend_x", "rad", "N_m"),
    ("bend_y", "rad", "N_m"),
)
#: What an event means, at the master and at the slave; {} is its value.
_WORDS = {
    1: ("running: the slave follows", "running: follows the master"),
    2: (
        "LINK LOST: the force fades to zero",
        "LINK LOST: holds where it is",
    ),
    3: (
        "link is back, waiting for the hand's consent",
        "link is back, holds until the hand at the master consents",
    ),
    4: ("the hand consents: session {}", "the hand at the master consents: session {}"),
    5: (
        "the slave has ended: the force fades to zero",
        "the master has ended: holds where it is",
    ),
    6: (
        "THE SLAVE'S DRIVES HAVE STOPPED by fault {}: the force fades to zero",
        "THE MASTER'S DRIVES HAVE STOPPED by fault {}: holds where it is",
    ),
    7: ("", "THE OTHER DRIVES OF THE SLAVE ARE SILENT: holds where it is"),
}
#: How an event is called in reports.
_NAMES = ("", "running", "lost", "back", "consent", "far ended", "far fault", "group silent")
#: Datagrams that a poor network may have damaged before the first good one.
_MOST_DAMAGED = 10
_VERSION = Packet().encode()[2]  # after two bytes that name the protocol
_REFUSED = (
    f"datagrams come, but none is one of this protocol (version {_VERSION}): "
    "does the other side run the same release?"
)
LOST, FAR_LEFT, FAR_FAULT = 2, 5, 6
#: A side that ends says so for so long [s].
_GOODBYE = 0.2


class FarWorld(ForeignWorld):
    """The world of a loop whose force comes over a network."""

    in_real_time = True

    def __init__(self, world: _core._World, what: str) -> None:
        super().__init__(world)
        self._what = what

    def for_run(self) -> FarWorld:
        """Return itself: one run at a time has the link."""
        return self

    @property
    def what(self) -> str:
        """Name for messages."""
        return self._what

    def __repr__(self) -> str:
        """Return what it is."""
        return f"FarWorld({self._what!r})"


@dataclass(frozen=True, kw_only=True)
class LinkEvent:
    """What has happened at one end of the link.

    Attributes
    ----------
    t : float
        Time of the loop there [s].
    what : str
        "running", "lost", "back", "consent", "far ended", "far fault", "group silent", "refused".
    text : str
        The same in a sentence.
    """

    t: float
    what: str
    text: str

    def row(self) -> dict[str, Any]:
        """Return it as plain values."""
        return {"t_s": self.t, "what": self.what, "text": self.text}


@dataclass(kw_only=True)
class LinkAtWork:
    """One end of the link while a loop runs: reports its events, and knows when to give up.

    Attributes
    ----------
    name : str
        "master" or "slave".
    end : object
        The end in C++.
    give_up : float
        After so long without a link the run ends [s].
    notify : callable
        Called with each event as it is found.
    """

    name: str
    end: _core._LinkEnd
    give_up: float
    notify: Callable[[LinkEvent], None]
    events: list[LinkEvent] = field(default_factory=list)
    ended_by: str = ""
    _since: float | None = None
    _far_ended: bool = False
    _refused: bool = False
    _seen: int = 0

    def look(self) -> bool:
        """Report what is new; return whether the run goes on."""
        for t, what, value in self.end.events(self._seen):
            self._seen += 1
            event = self._event(t, what, value)
            self.events.append(event)
            self.notify(event)
            if what in (FAR_LEFT, FAR_FAULT):
                self._far_ended = True
                other = "slave" if self.name == "master" else "master"
                self.ended_by = f"{other} ended" if what == FAR_LEFT else f"fault of the {other}"
        report = self.end.report()
        state = report["state"]
        if report["refused"] > _MOST_DAMAGED and not report["arrivals"]["received"]:
            self._report_refused(report["seconds"])
        now = time.monotonic()
        if state == 1:
            self._since = None
            return True
        if state == 0 and not self._far_ended:  # nobody has come yet
            return True
        if self._since is None:
            self._since = now
        # What has said goodbye does not come back; a force has faded by then.
        if now - self._since > (0.5 if self._far_ended else self.give_up):
            self.ended_by = self.ended_by or "link lost"
            return False
        return True

    def _report_refused(self, t: float) -> None:
        if self._refused:
            return
        self._refused = True
        event = LinkEvent(t=t, what="refused", text=_REFUSED)
        self.events.append(event)
        self.notify(event)

    def goodbye(self, fault: Fault) -> None:
        """After the loop has ended: let the other side know, by packets enough for a poor network."""
        self.end.fail(fault)
        end = time.monotonic() + _GOODBYE
        while time.monotonic() < end:
            self.end.leave()
            time.sleep(0.01)

    def _event(self, t: float, what: int, value: float) -> LinkEvent:
        shown: str = f"{value:g}"
        if what == FAR_FAULT:
            shown = fault_name(int(value))
        text = _WORDS[what][self.name == "slave"].format(shown)
        return LinkEvent(t=t, what=_NAMES[what], text=text)


def fault_name(number: int) -> str:
    """Return number and name of a fault."""
    try:
        return f"{number} ({Fault(number).name.lower().replace('_', ' ')})"
    except ValueError:
        return str(number)


def report_row(report: dict[str, Any]) -> dict[str, Any]:
    """Return a report of a link's end with units in its keys."""
    row = with_units(report, _core._LinkEnd.units())
    for key, value in report.items():
        if isinstance(value, (list, tuple)):
            row[key] = {
                f"{name}_{load if 'load' in key else unit}": number
                for (name, unit, load), number in zip(AXES, value, strict=True)
            }
    return row


@dataclass(frozen=True, kw_only=True)
class SideReport:
    """How one side of the chain went.

    Attributes
    ----------
    name : str
        "master" or "slave".
    ended_by : str
        "time", "link lost", "slave ended", "fault", "fault of the slave", "stop", or the name of a signal.
    fault : Fault
        Of its own drives.
    report : dict
        What the end of its link has met, as `ebac gastroscopy master --json` prints it.
    events : tuple of LinkEvent
        What has happened at the link.
    drives : tuple of str
        State of each drive, asked after the run.
    logs : tuple of str
        Files of the logs.
    skipped, latest : int, float
        Ticks that could not be kept, and the latest beginning of one [s].
    scope : dict
        Slave on simulated drives: what the gastroscope has met in the patient.
    """

    name: str
    ended_by: str
    fault: Fault
    report: dict[str, Any]
    events: tuple[LinkEvent, ...]
    drives: tuple[str, ...]
    logs: tuple[str, ...]
    skipped: int
    latest: float
    scope: dict[str, Any] = field(default_factory=dict)

    @property
    def good(self) -> bool:
        """No fault here or there, and not given up."""
        return self.fault == Fault.NONE and not (
            "fault" in self.ended_by or self.ended_by == "link lost"
        )

    def row(self) -> dict[str, Any]:
        """Return it as plain values, units in the keys."""
        return {
            "ended_by": self.ended_by,
            "fault": int(self.fault),
            "drives": list(self.drives),
            "logs": list(self.logs),
            "skipped_ticks": self.skipped,
            "latest_tick_s": self.latest,
            **report_row(self.report),
            "events": [one.row() for one in self.events],
            **({"scope": self.scope} if self.scope else {}),
        }
