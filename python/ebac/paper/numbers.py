"""Numbers the paper states: eq. (1) and the specifications."""

from __future__ import annotations

from ebac import presets
from ebac._core import copley_current
from ebac.paper.finding import Finding, judge, row
from ebac.specs import spec_sheet

#: The paper's example: half of the continuous torque, in the drive's units.
TORQUE_PERMILLE = 500
CONTINUOUS_TORQUE_1E5 = 5300
TORQUE_CONSTANT_1E5 = 5380
CURRENT = 0.4926  # A


def eq1() -> Finding:
    """Check the current of eq. (1), in Copley's units and in SI."""
    motor = presets.device("joystick").motor
    current = copley_current(TORQUE_PERMILLE, CONTINUOUS_TORQUE_1E5, TORQUE_CONSTANT_1E5)
    torque = TORQUE_PERMILLE / 1000 * motor.rated_torque
    in_si = motor.current(torque)
    right = abs(current - CURRENT) < 5e-5 and abs(in_si - CURRENT) < 5e-5
    return Finding(
        name="eq1",
        title="Eq. (1): the current of a torque command",
        claim="A torque command of 500 (0.0265 N m) makes the drive output 0.4926 A.",
        rows=[
            row("torque of the command 500", torque, "N m", 0.0265),
            row("current, eq. (1) in Copley's units", current, "A", CURRENT),
            row("current, torque over torque constant", in_si, "A", CURRENT),
        ],
        verdict=judge(right),
        why="Copley's units, thousandths of the continuous torque and 1e-5 N m, and SI give the "
        "same current.",
    )


def specs() -> Finding:
    """Check resolution, forces and workspace of the joystick against its parts; the peak force is an input."""
    device = presets.device("joystick")
    sheet = {spec.name: spec for spec in spec_sheet(device)}
    shown = ("resolution", "continuous force", "travel, chord", "travel, arc")
    tolerance = {"resolution": 5e-6, "continuous force": 0.05}
    right = [abs(sheet[n].value - (sheet[n].paper or 0)) < most for n, most in tolerance.items()]
    reach = sheet["travel, chord"].value >= 0.2
    stall = device.force(device.motor.stall_current)
    return Finding(
        name="specs",
        title="Specifications of the device",
        claim="Resolution 0.03 mm, continuous force 10.6 N, peak force 42.4 N, workspace 200 mm.",
        rows=[
            *(row(n, sheet[n].value, sheet[n].unit, sheet[n].paper) for n in shown),
            row("peak force, an input", sheet["peak force"].value, "N"),
            row("force of the motor's stall current", stall, "N"),
        ],
        verdict=judge(*right, reach),
        why="Resolution and continuous force follow from motor, encoder and capstan; the force holds at "
        "the handle only if the cable's sector is as large as the lever. The peak force is not checked: "
        "the paper does not give the drive's peak current, so the model's peak torque of 4 times the rated "
        "one is chosen from the paper's own 42.4 N over 10.6 N. The stall current that the paper gives for "
        "the motor would allow more. The 200 mm do not follow: "
        "they are the diameter of the sphere the handle moves on, and +-30 deg on a lever of 100 "
        "mm reach a chord of 100 mm, an arc of 105 mm.",
    )
