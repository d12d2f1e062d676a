"""What a run shows of its scenario that was likely not meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac._util.doubts import wall

if TYPE_CHECKING:
    from ebac.trace import Trace


def doubts(trace: Trace) -> tuple[str, ...]:
    """Return a sentence for what is doubtful of a simulated run; nothing for rows without a scenario."""
    if trace.scenario is None or "true.x" not in trace or not len(trace):
        return ()
    met = "" if trace["f_env"].any() else wall.before_target(trace.scenario)
    return tuple(filter(None, [left(trace), met]))


def left(trace: Trace) -> str:
    """Return that the handle was beyond the stops of its device, which a simulation does not have; else nothing."""
    import numpy as np

    if trace.scenario is None:
        return ""
    kinematics = trace.scenario.device.kinematics
    stops = np.atleast_1d(kinematics.travel * kinematics.stops)
    x = trace["true.x"].reshape(len(trace), -1)
    stops = stops[: x.shape[1]]
    if (x.max(axis=0) <= stops).all() and (x.min(axis=0) >= -stops).all():
        return ""
    x = np.abs(x)
    far = x - stops
    first, axis = int((far > 0).any(axis=1).argmax()), int(far.max(axis=0).argmax())
    return (
        f"the handle leaves the workspace of its device after {trace['t'][first]:.4g} s and is up to "
        f"{1e3 * x[:, axis].max():.4g} mm from the middle on axis {axis}; the stops of the device stand at "
        f"{1e3 * stops[axis]:.4g} mm (device.kinematics.limit) and are not simulated, so that no device does what "
        "follows; look at the sign of the law's force, and at the target of the hand"
    )
