"""Which drive a fault of the loop is of, as far as its row shows it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Fault

if TYPE_CHECKING:
    from ebac.trace import Trace

_Flags = NDArray[np.bool_]
#: Column, which of the drives it is, and how its value is read.
_SHOWN: dict[Fault, tuple[str, Callable[[NDArray[Any]], _Flags], str]] = {
    Fault.DRIVE_FAULT: ("bus.statusword", lambda word: (word & 0x48) == 0x08, "statusword 0x{:04X}"),
    Fault.DRIVE_DISABLED: ("bus.statusword", lambda word: (word & 0x6F) != 0x27, "statusword 0x{:04X}"),
    Fault.DRIVE_EMERGENCY: ("bus.emergency", lambda code: code != 0, "error code 0x{:04X}"),
    Fault.DRIVE_SILENT: ("bus.age", lambda age: (age > 0) & (age == age.max()), "no process data for {} ticks"),
    Fault.HEARTBEAT_LOST: ("bus.heartbeat", lambda state: (state != 5) & (state != -1), "NMT state {}"),
}  # fmt: skip


def of_drives(fault: Fault, trace: Trace, row: int, nodes: Sequence[int]) -> str:
    """Return the drives that a fault is of, and what they show: " of axis 1 (node 2, error code 0x2310)"; else nothing.

    Parameters
    ----------
    fault : Fault
        The fault.
    trace : Trace
        The rows.
    row : int
        That of the fault.
    nodes : sequence of int
        Node ids of the drives by axis; empty where they are not known.
    """
    column, which, text = _SHOWN.get(fault, ("", np.asarray, ""))
    if column not in trace:  # another fault, or a run without a bus
        return ""
    values = np.atleast_1d(trace[column][row])
    found = [
        f"axis {axis} ({f'node {nodes[axis]}, ' if axis < len(nodes) else ''}{text.format(int(values[axis]))})"
        for axis in np.flatnonzero(which(values)).tolist()
    ]
    return f" of {' and '.join(found)}" if found else ""
