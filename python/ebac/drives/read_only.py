"""Objects that a drive works out itself and lets nobody write: its rated current, and on some firmware its torque."""

from __future__ import annotations

from ebac.drives.errors import Refused
from ebac.drives.objects import Object
from ebac.drives.profile_fields import KEYS

#: Such objects, and what else of a profile their value follows from.
_FOLLOWS = {
    "rated_current": "motor.torque_constant or limits.rated_torque",
    "rated_torque": "motor.continuous_torque",
}


def refused(error: Refused, obj: Object, *, held: bytes, wanted: bytes) -> Refused:
    """Return the refusal to write an object, with what the drive holds and what the profile wants of it."""
    others = _FOLLOWS.get(obj.name)
    if others is None or error.node is None:
        return error
    own, asked = (obj.show(obj.decode(data)) for data in (held, wanted))
    key = next(one.name for one in KEYS if one.sets == obj.name)
    remedy = (
        f"the drive works it out from the data of its motor, {own}, and {key} of the profile is {asked}: "
        f"correct {key}, or {others}"
    )
    return Refused(error.node, obj, "writing", error.code, remedy)
