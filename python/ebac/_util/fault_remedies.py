"""What to do after a fault of the loop: the first steps, in the order in which they find most."""

from __future__ import annotations

from ebac._core import Fault

REMEDIES: dict[Fault, str] = {
    Fault.POSITION_NOT_FINITE: "check the encoder and the kinematics' parameters",
    Fault.FORCE_NOT_FINITE: "check the sensor's cable and its power",
    Fault.ENVIRONMENT_NOT_FINITE: "check the shape's parameters",
    Fault.LAW_NOT_FINITE: "look at `law.*` in the last rows of the trace",
    Fault.TORQUE_NOT_FINITE: "check the compensation's parameters",
    Fault.DEVICE: "in simulation: the simulation diverged; lower stiffness or sample time",
    Fault.DRIVE_FAULT: "read the drive's error (0x603F) and what caused it; then reset the fault",
    Fault.DRIVE_DISABLED: "see `bus.statusword`; check enable input, supply and quick stop",
    Fault.DRIVE_SILENT: (
        "first see whether the loop was late (`lateness`, `skipped`; `ebac doctor`); then "
        "`bus.missing`, `bus.late`, cable, termination, PDO mapping, `ebac bus load`"
    ),
    Fault.DRIVE_EMERGENCY: "look `bus.emergency` up in the drive's manual",
    Fault.HEARTBEAT_LOST: "see `bus.heartbeat`: 0 means it has restarted; check its supply",
    Fault.BUS_DOWN: "check cable, termination and bit rate, then bring the interface up again",
    Fault.ENCODER_JUMP: (
        "check the encoder's cable and shield; a corrupt position looks the same: see "
        "`bus.malformed`; under a law that shakes, the handle may really have been so fast"
    ),
    Fault.OVERSPEED: (
        "keep your hand off the handle and run `ebac drive signs FILE`: a motor or an encoder with the "
        "wrong sign looks like this; only when all signs are right, run again with a firm grip or a "
        "softer wall, as a law that shakes looks like this, too, or raise `limits.speed` if it is right "
        "to be so fast"
    ),
    Fault.WORKSPACE: "move the handle back by hand; read the zero of the encoders anew",
    Fault.FORCE_STALE: "check the sensor's network; see its loss and age",
    Fault.FORCE_SATURATED: "take the load off; calibrate a wider range",
    Fault.FORCE_DISCONNECTED: "check power, address and cable of the sensor",
    Fault.OVERRUNS: "`ebac doctor`, then `ebac jitter`; end other load on the machine",
    Fault.FORCE_ERROR: "look `ft.status` up with `ebac sensor read`; see Use a force sensor",
    Fault.STARVED: (
        "move the handle out of the wall: free motion refills the account; look for a resonance "
        "(`law.energy` falls while the handle rests) and declare it"
    ),
    Fault.TORQUE_MISMATCH: (
        "see `bus.actual_permille` and `bus.target_permille`; look for an offset (0x60B2), a wrong "
        "sign or scale in the drive, another master"
    ),
    Fault.SECOND_MASTER: "end the other loop or master: `candump` shows it; two processes may not run one device",
    Fault.ENCODER_FROZEN: (
        "check the encoder's cable and coupling; a force sensor with an offset or a stuck value looks "
        "the same: tare it; friction above `Limits.unexplained` too: declare it (`device.mechanics`)"
    ),
    Fault.TORQUE_REVERSED: (
        "a motor's wires, `signs.motor` or the sign of the force sensor is wrong, or the drive's "
        "polarity (0x607E) has changed"
    ),
    Fault.MOTION_IMPLAUSIBLE: (
        "check mass, damping and friction of `[device]` (half to twice the mass is allowed), the "
        "scale of the force sensor, and whether something but the hand touches the device. A force "
        "sensor that repeats an old value as if it were new is found as fault 24, 25 or 26"
    ),
    Fault.DUPLICATE_NODE: (
        "another node sends this drive's process data (TPDO 1): two drives with one node id, or a "
        "TPDO that is mapped to the same identifier; `ebac drive scan`, `candump`"
    ),
}
