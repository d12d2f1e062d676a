"""Positions of the axes before their motors have power, and distances to the surfaces of the virtual world."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from ebac._util.surfaces import GRAZE, PUSH, distances_at, push_at
from ebac.drives.errors import DriveError
from ebac.drives.state import State
from ebac.hardware.backends import hardware, simulated
from ebac.hardware.drive_setup import drives_at
from ebac.hardware.world_place import ends_of
from ebac.hardware.zero import from_zero

if TYPE_CHECKING:
    from ebac.hardware.backends import Backend
    from ebac.hardware.configuration import Configuration
    from ebac.scenario import Environment


class PositionError(DriveError):
    """An axis is outside the workspace, the handle inside the world, or the zero of the encoders not confirmed."""


def axis_name(axis: int, node: int) -> str:
    """Return how messages and tables name an axis: its number from 0, and the node id of its drive."""
    return f"axis {axis} (node {node})"


@dataclass(frozen=True, kw_only=True)
class AxisPosition:
    """Position of an axis.

    Attributes
    ----------
    axis, node : int
        Number of the axis, from 0, and node id of its drive.
    counts, zero_counts : int
        Counts that the drive shows (0x6064), and counts that it shows at the zero of the configuration.
    angle_rad, position_m : float
        Angle of the joint from that zero [rad], and the displacement of the handle [m], to which the limits of the
        workspace apply.
    """

    axis: int
    node: int
    counts: int
    zero_counts: int
    angle_rad: float
    position_m: float

    def row(self) -> dict[str, Any]:
        """Return the position as plain values, for JSON."""
        return asdict(self)

    def __str__(self) -> str:
        """Return it in words."""
        return (
            f"{axis_name(self.axis, self.node)} stands at {1e3 * self.position_m:+.2f} mm "
            f"({self.counts} counts, its zero at {self.zero_counts})"
        )


def axis_positions(known: Configuration, *, simulate: bool = False) -> list[AxisPosition]:
    """Read the position of each axis. Nothing is written to the drives; no drive may have power.

    Parameters
    ----------
    known : Configuration
        The device.
    simulate : bool
        Whether simulated drives stand in for the real ones.

    Raises
    ------
    PositionError
        When a drive has power, because another program may command it.
    DriveError
        When a drive does not answer.
    """
    with simulated(known) if simulate else hardware(known) as backend:
        return read_positions(known, backend)


def read_positions(known: Configuration, backend: Backend) -> list[AxisPosition]:
    """Read the position of each axis from the drives of a backend. Raises the same errors as `axis_positions`."""
    with drives_at(backend, known.drives.nodes) as drives:
        for drive in drives:
            if drive.state is State.OPERATION_ENABLED:
                raise PositionError(
                    f"node {drive.node} has power: end the program that commands it, then read its position",
                    node=drive.node,
                )
        return positions_of(known, [drive.number("position") for drive in drives])


def positions_of(known: Configuration, counts: Sequence[int]) -> list[AxisPosition]:
    """Return the positions of axes whose drives show these counts."""
    device = known.device
    axes = zip(
        known.drives.nodes,
        counts,
        device.kinematics.travel,
        known.zero.of_all(device.axes),
        known.signs.of_all(device.axes).encoder,
        strict=True,
    )
    found = []
    for axis, (node, shown, travel, zero, sign) in enumerate(axes):
        position = sign * from_zero(shown, zero) * device.count * (float(travel) / device.radius)
        found.append(
            AxisPosition(
                axis=axis,
                node=node.id,
                counts=shown,
                zero_counts=zero,
                angle_rad=position / float(travel),
                position_m=position,
            )
        )
    return found


def positions_at_zero(known: Configuration) -> list[AxisPosition]:
    """Return the positions of axes that stand at the zero of the configuration, as in a run on the virtual clock."""
    zeros = known.zero.of_all(known.device.axes)
    return [
        AxisPosition(
            axis=axis, node=node.id, counts=zero, zero_counts=zero, angle_rad=0.0, position_m=0.0
        )
        for axis, (node, zero) in enumerate(zip(known.drives.nodes, zeros, strict=True))
    ]


def check_workspace(known: Configuration, positions: Sequence[AxisPosition]) -> None:
    """Raise PositionError for an axis that stands outside the workspace, where a run would end at once."""
    ends = ends_of(known.device, known.limits).tolist()
    for one, end in zip(positions, ends, strict=True):
        if abs(one.position_m) > end:
            raise PositionError(
                f"{one}: must lie within {1e3 * end:g} mm of its zero (limits.end = {known.limits.end:g} m). "
                "Nothing has power. "
                "Move the handle back by hand; where it is there already, put it at its zero and read that by "
                "`ebac drive zero FILE --write`",
                node=one.node,
            )


def check_outside(
    known: Configuration, positions: Sequence[AxisPosition], environment: Environment
) -> None:
    """Raise PositionError for a handle that stands inside the virtual world, which would throw it out."""
    inside = {
        name: -way for name, way in distances(known, positions, environment).items() if way < -GRAZE
    }
    if not inside or (force := push_at(environment, _place(known, positions))) < PUSH:
        return
    depths = " and ".join(
        f"{1e3 * depth:.2f} mm inside the {name}" for name, depth in inside.items()
    )
    raise PositionError(
        f"the handle stands {depths} and would be pushed with {force:.3g} N at once: it must begin outside, or at most "
        f"{1e3 * GRAZE:g} mm inside. Nothing has power. Move the handle out by hand, or give the world another place: "
        "[environment] is in metres from the zero of the encoders"
    )


def distances(
    known: Configuration, positions: Sequence[AxisPosition], environment: Environment | None = None
) -> dict[str, float]:
    """Return how far the handle is from each surface of the virtual world [m]; negative inside. A moving wall at rest.

    Parameters
    ----------
    known : Configuration
        The device.
    positions : sequence of AxisPosition
        The positions of all its axes.
    environment : Free, Wall, Corner, Disc or worlds.World, optional
        The virtual world; that of the configuration, if not given.
    """
    world = known.environment if environment is None else environment
    return distances_at(world, _place(known, positions))


def _place(known: Configuration, positions: Sequence[AxisPosition]) -> list[float]:
    """Return the coordinates of the handle [m]."""
    return list(known.device.kinematics.forward([one.angle_rad for one in positions]))
