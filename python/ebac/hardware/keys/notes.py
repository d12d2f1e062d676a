"""What a user needs to know of a key beyond its meaning: where a data sheet has it, and what a wrong value does."""

from __future__ import annotations

#: By table and key. Data sheets are named in maxon's words, with the factor to SI units.
NOTES: dict[str, str] = {
    "device.preset": "parts and keys that are left out are those of this device",
    "device.motor.torque_constant": "data sheet: torque constant [mN m/A] x 1e-3",
    "device.motor.rated_torque": "data sheet: nominal torque [mN m] x 1e-3; over torque_constant it is the current "
    "that a run allows for ever",
    "device.motor.rated_current": "data sheet: nominal current; only compared with rated_torque / torque_constant",
    "device.motor.stall_current": "the same in a data sheet; the peak current is never larger",
    "device.motor.rotor_inertia": "data sheet: rotor inertia [g cm^2] x 1e-7, with encoder and drum",
    "device.motor.ripple": "simulated; try 0.005",
    "device.motor.cogging": "simulated; 0 for an ironless winding",
    "device.motor.waves": "simulated; often twice the commutator bars or six times the pole pairs",
    "device.drive.current_lag": "1 / (2 pi x bandwidth of the current loop [Hz])",
    "device.drive.peak_ratio": "peak current of the drive x torque_constant / rated_torque; less where motor, cable or "
    "hand takes less",
    "device.drive.permille": "true for a drive that takes its torque so",
    "device.drive.current_offset": "simulated; the drive does not show it",
    "device.drive.current_noise": "simulated",
    "device.encoder.counts_per_turn": "of the motor, not of the lever: 4 x lines. Counts per turn in the data sheet of "
    "an incremental encoder are its lines",
    "device.capstan.drum_radius": "to the middle of the cable; for a gear any two radii of its ratio",
    "device.capstan.sector_radius": "to the middle of the cable",
    "device.kinematics.Linear.axes": "each with the same motor, drive and encoder",
    "device.kinematics.Linear.radius": "from the joint of the lever to the handle",
    "device.kinematics.Linear.limit": "from the middle to the stop: degrees x 0.01745; edge and end of [limits] follow "
    "from it",
    "device.mechanics.handle_mass": "moment of inertia of lever and handle about the joint [kg m^2] / radius^2",
    "device.mechanics.damping": "at the handle; `ebac identify device` finds it",
    "device.mechanics.coulomb": "at the handle, as much as is surely there: the observer counts with 0.8 of it; `ebac "
    "identify device` finds it",
    "device.mechanics.gravity": "0 where springs or a counterweight carry the handle, else 9.81",
    "device.mechanics.cable_stiffness": "at the handle",
    "device.mechanics.cable_damping": "acts with cable_stiffness only",
    "device.mechanics.backlash": "at the handle",
    "device.sensor.lag": "1 / (2 pi x cut-off of its filter [Hz])",
    "device.sensor.noise": "at rest: measure it",
    "device.sensor.quantum": "data sheet: resolution; coarser than 0.06 N costs quiet and walls",
    "device.sensor.range": "data sheet: measuring range along the axis",
    "device.sensor.period": "1 / data rate [Hz]",
    "device.sensor.stops_at": "a simulated failure",
    "device.sensor.resumes_at": "a simulated failure",
    "device.sensor.repeats": "a simulated failure",
    "device.sensor.disconnects": "a simulated failure",
    "device.sensor.scale": "try 0.98 and 1.02",
    "device.sensor.fitted": "false for a device without one",
    "bus.drives": "a network file, or the name of one that comes with ebac: `ebac drive profile` lists them",
    "bus.setup": 'with "apply" a backup is written before the drive',
    "signs.motor": "one for each axis; without it all are 1. `ebac drive signs FILE --write` finds them",
    "signs.encoder": "one for each axis; without it all are 1. `ebac drive signs FILE --write` finds them",
    "zero.counts": "without it all are 0. `ebac drive zero FILE --write` reads them from the drives",
    "timing.dt": "each drive must have it as its SYNC period (0x1006); law and observer are designed for it",
    "timing.delay": "over a CAN bus 1 at least, which is that of drives that take their torque at the next SYNC: "
    "measure it. Law and observer are designed for it",
    "environment.type": "World has bodies: `ebac worlds NAME` prints some",
    "environment.Wall.position": "a wall that the handle never reaches is refused",
    "engine.command": "as --engine-command of `ebac run`",
    "law.name": "one of your own is given as --law",
    "limits.continuous_current": "follows from the motor of [device]",
    "limits.peak_current": "follows from motor and drive of [device]",
    "limits.slew": "follows from motor and drive of [device]",
    "limits.edge": "follows from the stops of [device]: 5 mm before those of the first axis, or halfway to stops "
    "closer than 10 mm",
    "limits.end": "follows from the stops of [device]: as far behind them as edge before them. Only a wrong zero or "
    "encoder leads there",
    "limits.starved": "the part that withholds it is the guard",
    "sensor.bias": "not simulated",
    "observer.mass": "follows from [device]",
    "observer.damping": "follows from [device]",
    "observer.friction": "follows from [device]: 0.8 of coulomb",
    "observer.count": "follows from [device]",
    "observer.current_lag": "follows from [device]; rather 0.05 ms too long than too short",
    "observer.force_lag": "follows from [device]",
    "observer.force_noise": "follows from noise of [device.sensor], at least 0.03 N",
    "observer.delay": "follows from [timing]",
    "simulated.signs.motor": "what the simulated device needs; without it as [signs]",
    "simulated.signs.encoder": "what the simulated device needs; without it as [signs]",
    "simulated.zero.counts": "what the simulated drives have; without it as [zero]",
    "simulated.bus.drive_heartbeat": "follows from the profiles",
    "simulated.bus.loop_silence": "follows from the profiles",
    "simulated.bus.torque_silence": "follows from the profiles",
    "simulated.bus.peak_ratio": "follows from the profiles",
    "simulated.hand.preset": "keys that are left out are those of this hand",
    "profile.motor.torque_constant": "1 mN m/A is 0.001 N m/A",
    "profile.motor.continuous_torque": "must equal limits.rated_torque",
    "profile.motor.peak_torque": "no more than the motor takes: peak_ratio of [device.drive] x rated, 4 x for the "
    "joystick",
    "profile.motor.counts_per_turn": "4 x lines with quadrature",
    "profile.limits.rated_torque": "the value of 1000 per mille; whole mN m within 1 %, unless the drive has a finer "
    "unit (as an EPOS4)",
    "profile.limits.rated_current": "rated_torque / torque_constant within 2 %, or a factor of 1.5, sqrt(2), sqrt(3) "
    "or sqrt(6) away for other amperes. A motor's nominal current is some per cent more",
    "profile.limits.max_torque": "as motor.peak_torque",
    "profile.torque.mode": "10 and 4 on the drive",
    "profile.torque.slope": "profile torque ramps with it, and needs it",
    "profile.drive.quick_stop": "1 and 5 brake by the slow-down ramp; 5 and 6 stay",
    "profile.drive.connection_lost": "0 is refused",
    "profile.sync.period": "the same as timing.dt of the configuration",
    "profile.emcy.on": "with the identifier 0x80 + node",
    "profile.heartbeat.consumer": "the number is the longest silence of the loop",
    "profile.pdo.rpdo1.objects": "rpdo2 to rpdo4 and tpdo1 to tpdo4 have the same keys",
    "profile.pdo.rpdo1.event": "of the PDO with target_torque it is the drive's deadline for torques",
    "profile.pdo.rpdo1.inhibit": "needed for events from the drive",
}

#: What must not be overlooked.
WARNINGS: dict[str, str] = {
    "device.motor.torque_constant": "a wrong one makes every force wrong",
    "device.mechanics.damping": "give a lower bound: laws count on it",
    "device.sensor.noise": "0 makes laws with the force sensor look better than they are",
    "environment.type": "the default is a wall of 10 kN/m at 0 m, where the zero of the handle is",
    "limits.thermal_time": "16 s is from memory of the RE 30's data sheet, whatever motor [device] has: take yours "
    "from its data sheet, as too large a value burns the winding",
    "profile.limits.max_torque": "the drive's own limit, also when the loop is wrong",
    "profile.limits.max_current": "the drive's own limit, also when the loop is wrong",
    "profile.heartbeat.consumer": "0 switches the watch off",
}

#: Names of the faults of a run that is beyond a limit; at the others the force is limited and the run goes on.
FAULTS: dict[str, tuple[str, ...]] = {
    "speed": ("OVERSPEED",),
    "jump": ("ENCODER_JUMP",),
    "end": ("WORKSPACE",),
    "force_age": ("FORCE_STALE",),
    "watch_force": ("FORCE_STALE", "FORCE_SATURATED", "FORCE_DISCONNECTED", "FORCE_ERROR"),
    "watch_motion": ("ENCODER_FROZEN", "TORQUE_REVERSED", "MOTION_IMPLAUSIBLE"),
    "unexplained": ("ENCODER_FROZEN", "TORQUE_REVERSED", "MOTION_IMPLAUSIBLE"),
    "overruns": ("OVERRUNS",),
    "pause": ("OVERRUNS",),
    "starved": ("STARVED",),
}
