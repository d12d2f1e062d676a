"""Find the signs of the encoders without power: a person pushes the handle along each axis."""

from __future__ import annotations

from collections.abc import Callable

from ebac.hardware.axis_positions import PositionError, axis_name, positions_of, read_positions
from ebac.hardware.backends import hardware
from ebac.hardware.configuration import Configuration
from ebac.hardware.zero import Zero

#: Least way of a handle that shows a direction [m].
LEAST_WAY = 2e-3
_DIRECTIONS = "xyz"


def find_encoder_signs(known: Configuration, push: Callable[[str], None]) -> tuple[int, ...]:
    """Return the correct sign of each encoder, 1 or -1, for a handle that a person pushes along each axis in turn.

    No motor has power, and nothing is written to a drive. `find_signs` takes the result as `encoder`, and then knows
    the signs of the motors without a force sensor, too.

    Parameters
    ----------
    known : Configuration
        The device.
    push : callable
        Called once for each axis, with the request in words: the axis and its direction, from +x for axis 0 to +z for
        axis 2. To return when the handle was pushed and is held there.

    Raises
    ------
    PositionError
        When a drive has power; when the handle moved by less than 2 mm along the axis, or farther along another one.
    DriveError
        When a drive does not answer.
    """
    signs = known.signs.of_all(known.device.axes).encoder
    found = []
    with hardware(known) as backend:
        now = read_positions(known, backend)
        for axis, node in enumerate(known.drives.nodes):
            name, way = axis_name(axis, node.id), f"+{_DIRECTIONS[axis]}"
            before = known.replace(zero=Zero(counts=tuple(one.counts for one in now)))
            push(f"Push the handle towards {way}, along {name}, by about 10 mm, and hold it there.")
            now = read_positions(known, backend)
            moved = [one.position_m for one in positions_of(before, [one.counts for one in now])]
            if abs(moved[axis]) < LEAST_WAY:
                raise PositionError(
                    f"{name} moved by {1e3 * moved[axis]:+.2f} mm: must be at least {1e3 * LEAST_WAY:g} mm; push the "
                    f"handle farther towards {way}, or look at the encoder. Nothing has power",
                    node=node.id,
                )
            other = max(range(len(moved)), key=lambda i: abs(moved[i]))
            if other != axis:
                raise PositionError(
                    f"{axis_name(other, known.drives.nodes[other].id)} moved by {1e3 * moved[other]:+.2f} mm, farther "
                    f"than {name}, which moved by {1e3 * moved[axis]:+.2f} mm: push the handle towards {way} alone; if "
                    "that was so, the drives are in the wrong order in the network file. Nothing has power",
                    node=node.id,
                )
            found.append(signs[axis] if moved[axis] > 0 else -signs[axis])
    return tuple(found)
