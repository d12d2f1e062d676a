"""The rated current of a motor, and the one that follows from its torques."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac._core import Motor

#: The current of the data sheet and the one that follows from torques differ by this factor at most.
FACTOR = 2.0
#: What follows from two numbers of a motor, and their units.
RATIO = "device.motor: rated_torque / torque_constant"
LOOK = "rated_torque is in N m (mN m x 1e-3), torque_constant in N m/A (mN m/A x 1e-3)"


def contradiction(motor: Motor) -> str:
    """Return how the rated current of a motor contradicts its torques; "" where they agree or it is not given."""
    current, given = motor.current(motor.rated_torque), motor.rated_current
    # A file need not have a rated current: that of the reference says nothing of another motor.
    if given == type(motor)().rated_current or given / FACTOR <= current <= given * FACTOR:
        return ""
    return (
        f"{RATIO} = {current:.4g} A, but rated_current = {given:.4g} A: should agree within a factor of {FACTOR:g}; "
        f"{LOOK}"
    )
