"""What a log becomes in ROS 2: messages of standard types, and one of our own with every column."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.logs.cdr import Cdr
from ebac.logs.events import FATAL, INFO, LEVELS, WARNING, Event
from ebac.logs.layout import SCHEMA_NAME, Layout

#: Topics of a bag.
ROW, JOINTS, WRENCH, EVENTS = "/ebac/row", "/ebac/joint_states", "/ebac/wrench", "/ebac/events"
#: The frame of the measured force.
FRAME = "handle"

_BREAK = "=" * 80 + "\nMSG: "
_TIME = f"{_BREAK}builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
_HEADER = f"{_BREAK}std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n{_TIME}"
_VECTOR = f"{_BREAK}geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
#: Standard types, with all they consist of.
TYPES = {
    JOINTS: (
        "sensor_msgs/msg/JointState",
        "std_msgs/Header header\nstring[] name\nfloat64[] position  # [rad]\nfloat64[] velocity  # [rad/s]\n"
        f"float64[] effort  # [N m]\n{_HEADER}",
    ),
    WRENCH: (
        "geometry_msgs/msg/WrenchStamped",
        f"std_msgs/Header header\ngeometry_msgs/Wrench wrench\n{_HEADER}{_BREAK}geometry_msgs/Wrench\n"
        f"geometry_msgs/Vector3 force  # [N]\ngeometry_msgs/Vector3 torque  # [N m]\n{_VECTOR}",
    ),
    EVENTS: (
        "rcl_interfaces/msg/Log",
        "byte DEBUG=10\nbyte INFO=20\nbyte WARN=30\nbyte ERROR=40\nbyte FATAL=50\n"
        "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\nstring function\n"
        f"uint32 line\n{_TIME}",
    ),
}
_LEVELS = {INFO: 20, WARNING: 30, FATAL: 50}
#: Seconds of a stamp of ROS 2 at most.
_MOST_SECONDS = (1 << 31) - 1
_FIELD = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


@dataclass(frozen=True)
class Topic:
    """A topic that has a message for each row.

    Attributes
    ----------
    name, schema, definition : str
        Of the topic, its type, and the text of that.
    encode : callable
        Rows as they lie in a log to their messages, one behind the other, all of one length.
    """

    name: str
    schema: str
    definition: str
    encode: Callable[[NDArray[Any]], bytes | bytearray]


def topics(layout: Layout) -> list[Topic]:
    """Return the topics for rows of this layout: all columns, and standard messages for what it has.

    Raises
    ------
    ValueError
        When a column has a name that no field of a message can have.
    """
    for column in layout.columns:
        if not _FIELD.fullmatch(column.field):
            raise ValueError(
                f"column {column.name!r}: a field of a ROS 2 message is made of the letters a to z, digits and _"
            )
    sizes = {column.name: column.size for column in layout.columns}
    found = [Topic(ROW, SCHEMA_NAME, layout.ros2msg(), _row(layout))]
    if "q" in sizes:
        found.append(Topic(JOINTS, *TYPES[JOINTS], _joints(sizes)))
    if sizes.get("f_meas", 4) <= 3:
        found.append(Topic(WRENCH, *TYPES[WRENCH], _wrench(sizes["f_meas"])))
    return found


def log_message(event: Event, time: int) -> bytes:
    """Return an event, at a time [ns], as rcl_interfaces/msg/Log; tick and values stand behind its words, as JSON."""
    message = Cdr()
    message.put("i", min(time // 1_000_000_000, _MOST_SECONDS))
    message.put("I", time % 1_000_000_000)
    message.put("B", _LEVELS[LEVELS.get(event.kind, INFO)])
    message.text(f"ebac.{event.kind}")
    message.text(f"{event.message} {json.dumps({'tick': event.tick, **event.values})}")
    message.text("")
    message.text("")
    message.put("I", 0)
    return bytes(message)


def _row(layout: Layout) -> Callable[[NDArray[Any]], bytes]:
    """Every column; a log has it in CDR already."""
    fields: Any = layout.record.fields
    first = fields["#cdr"][1]
    size = layout.record.itemsize

    def encode(rows: NDArray[Any]) -> bytes:
        whole = np.frombuffer(rows.tobytes(), np.uint8).reshape(len(rows), size)
        return whole[:, first:].tobytes()

    return encode


def _joints(sizes: dict[str, int]) -> Callable[[NDArray[Any]], bytearray]:
    joints = sizes["q"]
    message = _with_header("")
    message.put("I", joints)
    for i in range(joints):
        message.text(f"joint_{i}")
    known = [name for name in ("q", "dq", "tau") if sizes.get(name) == joints]
    for name in ("q", "dq", "tau"):  # a list that is not known is empty
        size = joints if name in known else 0
        message.put("I", size)
        message.room(name, "<f8", size)
    return _filled(message, {name: name for name in known})


def _wrench(axes: int) -> Callable[[NDArray[Any]], bytearray]:
    message = _with_header(FRAME)
    message.room("force", "<f8", axes)
    message.room("rest", "<f8", 6 - axes)  # 0: RViz shows no wrench with a NaN in it
    return _filled(message, {"force": "f_meas"})


def _with_header(frame: str) -> Cdr:
    message = Cdr()
    message.room("sec", "<i4")
    message.room("nanosec", "<u4")
    message.text(frame)
    return message


def _filled(message: Cdr, columns: dict[str, str]) -> Callable[[NDArray[Any]], bytearray]:
    def encode(rows: NDArray[Any]) -> bytearray:
        messages, data = message.rows(len(rows))
        seconds, messages["nanosec"] = np.divmod(rows["#log_time"], np.uint64(1_000_000_000))
        messages["sec"] = np.minimum(seconds, np.uint64(_MOST_SECONDS))
        for place, column in columns.items():
            messages[place] = rows[column]
        return data

    return encode
