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
    """Check resolution, forces and workspace of the joystick against its parts."""
    sheet = {spec.name: spec for spec in spec_sheet(presets.device("joystick"))}
    shown = ("resolution", "continuous force", "peak force", "travel, chord", "travel, arc")
    tolerance = {"resolution": 5e-6, "continuous force": 0.05, "peak force": 0.05}
    right = [abs(sheet[n].value - (sheet[n].paper or 0)) < most for n, most in tolerance.items()]
    reach = sheet["travel, chord"].value >= 0.2
    return Finding(
        name="specs",
        title="Specifications of the device",
        claim="Resolution 0.03 mm, continuous force 10.6 N, peak force 42.4 N, workspace 200 mm.",
        rows=[row(n, sheet[n].value, sheet[n].unit, sheet[n].paper) for n in shown],
        verdict=judge(*right, reach),
        why="Resolution and forces follow from motor, encoder and capstan; the forces hold at the "
        "handle only if the cable's sector is as large as the lever. The 200 mm do not follow: "
        "they are the diameter of the sphere the handle moves on, and +-30 deg on a lever of 100 "
        "mm reach a chord of 100 mm, an arc of 105 mm.",
    )
