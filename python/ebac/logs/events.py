"""What happened during a run, beside its rows: parameter changes, faults, rows lost."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ebac._util.wrong_calls import plain_constructor

SCHEMA_NAME = "foxglove.Log"  # a type Foxglove shows in its Log panel by itself
#: Severity of each kind, in the numbers of that type; any other kind is information.
INFO, WARNING, FATAL = 2, 3, 5
LEVELS = {"lost": WARNING, "fault": FATAL}

_TIME = {"type": "object", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}}
SCHEMA = {
    "type": "object",
    "properties": {
        "timestamp": _TIME,
        "level": {"type": "integer", "description": "2 information, 3 warning, 5 fatal"},
        "message": {"type": "string", "description": "what happened, in words"},
        "name": {
            "type": "string",
            "description": "kind: parameter, fault, lost, or the user's own",
        },
        "file": {"type": "string"},
        "line": {"type": "integer"},
        "tick": {"type": "integer", "description": "number of the tick"},
        "t": {"type": "number", "description": "[s] time since the start"},
        "values": {"type": "object", "description": "what belongs to it, units in the keys"},
    },
}


#: An event beyond so long a time [s], or this many ticks, is damage.
MOST_TIME, MOST_TICK = 1e9, 1 << 62


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Event:
    """Something that happened in a tick.

    Attributes
    ----------
    kind : str
        `parameter`, `fault`, `lost`, or a word of your own.
    message : str
        What happened, in words.
    tick : int
        Number of the tick.
    t : float
        Time since the start [s].
    values : dict
        Numbers and words that belong to it, the unit in the key.
    """

    kind: str
    message: str
    tick: int
    t: float
    values: dict[str, Any] = field(default_factory=dict)

    def time_ns(self, start_ns: int) -> int:
        """Return when it was [ns], for a run whose t was 0 at `start_ns`."""
        return max(0, start_ns + round(1e9 * self.t))

    def to_json(self, start_ns: int) -> bytes:
        """Return it as the message in a log."""
        seconds, nanoseconds = divmod(self.time_ns(start_ns), 1_000_000_000)
        message = {
            "timestamp": {"sec": seconds, "nsec": nanoseconds},
            "level": LEVELS.get(self.kind, INFO),
            "message": self.message,
            "name": self.kind,
            "file": "",
            "line": 0,
            "tick": self.tick,
            "t": self.t,
            "values": self.values,
        }
        return json.dumps(message).encode()

    @classmethod
    def from_json(cls, data: bytes) -> Self:
        """Read what `to_json` wrote.

        Raises
        ------
        ValueError
            When it is not that.
        """
        try:
            document = json.loads(data)
            if isinstance(document["tick"], bool) or isinstance(document["t"], bool):
                raise TypeError("true is no number")
            event = cls(
                kind=str(document["name"]),
                message=str(document["message"]),
                tick=int(document["tick"]),
                t=float(document["t"]),
                values=dict(document["values"]),
            )
        except (KeyError, TypeError, ValueError, OverflowError, RecursionError) as error:
            raise ValueError(f"not an event of ebac ({error})") from None
        if not abs(event.t) < MOST_TIME or not abs(event.tick) < MOST_TICK:
            raise ValueError(f"an event in tick {event.tick}, at {event.t:g} s: cannot be")
        return event


def faults_of(data: Mapping[str, NDArray[Any]], before: int) -> list[Event]:
    """Return an event for each row in which a fault appears or changes; `before` is that of the row before them."""
    fault = data["fault"].astype(np.int64)
    new = np.flatnonzero((fault != 0) & (np.diff(fault, prepend=before) != 0))
    return [
        Event(
            kind="fault",
            message=f"fault {fault[i]} ({fault_name(int(fault[i]))})",
            tick=int(data["tick"][i]),
            t=float(data["t"][i]),
            values={"fault": int(fault[i])},
        )
        for i in new
    ]


def fault_name(number: int) -> str:
    """Return the name of a fault in words."""
    from ebac._core import Fault

    try:
        return Fault(number).name.lower().replace("_", " ")
    except ValueError:
        return "unknown to this version"
