"""Numbers of a device file that are possible, but more likely in a wrong unit, or that cost a law its quiet."""

from __future__ import annotations

from math import radians
from typing import TYPE_CHECKING

from ebac._core import Linear
from ebac._util.rated_current import LOOK, RATIO, contradiction

if TYPE_CHECKING:
    from ebac._core import Device

#: What handles and their motors have; a number beyond is possible.
CURRENT, FORCE, MASS = (0.05, 50.0), (0.1, 1e3), (1e-3, 20.0)
#: Coarsest count of an encoder at the handle [m] that is usual.
COUNT = 2e-4
#: Steps of a force sensor from which on `ebac` is neither quiet nor keeps every wall [N].
COARSE = 0.1
#: Most noise of a force sensor [N], slowest current loop of a drive [s], and strongest weight [m/s^2] that are usual.
NOISE, CURRENT_LAG, GRAVITY = 1.0, 5e-3, 9.82
#: No motor takes so many times its continuous current when it is stalled.
STALL = 200.0
#: No lever turns farther from its middle [rad], nor moves a cable at its drum farther [m].
TURN, WAY = 1.6, 1.0


def doubts(device: Device, *, no_observer: str = "Scenario(observer=False)") -> list[str]:
    """Return a sentence for each number that is doubtful: its value, what is usual, and where to look.

    `no_observer` is how the reader turns the observer off.
    """
    motor = device.motor
    current = motor.current(motor.rated_torque)
    found = []
    if wrong := contradiction(motor):
        found.append(wrong)
    elif not CURRENT[0] <= current <= CURRENT[1]:
        found.append(f"{RATIO} = {current:.4g} A: {_usual(CURRENT, 'A')}; {LOOK}")
    if not FORCE[0] <= device.peak_force <= FORCE[1]:
        found.append(
            f"device: peak force at the handle = {device.peak_force:.4g} N: {_usual(FORCE, 'N')}; rated_torque is in "
            "N m (mN m x 1e-3), the radii of capstan and lever in m (mm x 1e-3)"
        )
    if device.count > COUNT:
        found.append(
            f"device: a count of the encoder = {1e3 * device.count:.3g} mm at the handle: usual are at most "
            f"{1e3 * COUNT:g} mm; device.encoder: counts_per_turn is that of the motor after quadrature, 4 x lines, "
            "and the radii are in m (mm x 1e-3)"
        )
    if device.sensor.fitted and device.sensor.quantum >= COARSE:
        found.append(
            f"device.sensor.quantum = {device.sensor.quantum:g} N: with steps of the force from {COARSE:g} N on `ebac` "
            f"with the observer is not quiet and can lose walls; {no_observer} runs it on the encoder alone"
        )
    found += _unused_noise(device)
    found += _single_numbers(device)
    found += _far_stops(device)
    drum, sector = device.capstan.drum_radius, device.capstan.sector_radius
    if drum > sector:
        found.append(
            f"device.capstan: drum_radius = {drum:g} m is larger than sector_radius = {sector:g} m: the handle is "
            "faster than the motor and has less torque; the drum is that on the motor"
        )
    if not MASS[0] <= device.mass <= MASS[1]:
        found.append(
            f"device: mass at the handle = {device.mass:.4g} kg: {_usual(MASS, 'kg')}; handle_mass is in kg "
            "(g x 1e-3), rotor_inertia in kg m^2 (g cm^2 x 1e-7)"
        )
    return found


def of_change(before: Device, after: Device, *, no_observer: str) -> list[str]:
    """Return what a change makes doubtful of a device; who takes its force sensor off means the noise to be unused."""
    known = doubts(before, no_observer=no_observer)
    if before.sensor.fitted:
        known += _unused_noise(after)
    return [text for text in doubts(after, no_observer=no_observer) if text not in known]


def _unused_noise(device: Device) -> list[str]:
    if device.sensor.fitted or not device.sensor.noise > 0:
        return []
    return [
        f"device.sensor: fitted = false, but noise = {device.sensor.noise:g} N: the device has no force "
        "sensor, and the noise is not used; leave out fitted where it has one"
    ]


def _single_numbers(device: Device) -> list[str]:
    """Return what is unusual of numbers that nothing else of the device follows from."""
    motor, drive, mechanics, sensor = device.motor, device.drive, device.mechanics, device.sensor
    most_stall = STALL * motor.current(motor.rated_torque)
    found = []
    if sensor.fitted and sensor.noise > NOISE:
        found.append(
            f"device.sensor.noise = {sensor.noise:g} N: usual are at most {NOISE:g} N; it is the standard deviation at "
            f"rest in N, {sensor.noise:g} mN are {sensor.noise / 1e3:g}"
        )
    # The stall current of the reference belongs to no other motor.
    if motor.stall_current != type(motor)().stall_current and motor.stall_current > most_stall:
        found.append(
            f"device.motor.stall_current = {motor.stall_current:g} A: usual are at most {STALL:g} times the continuous "
            f"current, {most_stall:.4g} A; it is in A, {motor.stall_current:g} mA are {motor.stall_current / 1e3:g}"
        )
    if drive.current_lag > CURRENT_LAG:
        found.append(
            f"device.drive.current_lag = {drive.current_lag:g} s: usual are at most {CURRENT_LAG:g} s; it is the time "
            "constant of the current loop in s (ms x 1e-3), 1 / (2 pi x its bandwidth in Hz)"
        )
    if not 0 <= mechanics.gravity <= GRAVITY:
        ways = "pulls along -x" if isinstance(device.kinematics, Linear) else "pulls up"
        how = ways if mechanics.gravity < 0 else "is more than that of the earth"
        found.append(
            f"device.mechanics.gravity = {mechanics.gravity:g} m/s^2: {how}; usual are 9.81, and 0 where a spring or "
            "counterweight carries the handle"
        )
    if 0 < mechanics.breakaway < mechanics.coulomb:
        found.append(
            f"device.mechanics.breakaway = {mechanics.breakaway:g} N is less than coulomb = {mechanics.coulomb:g} N: "
            "friction at standstill is never below that in motion, so that it is coulomb; give the larger one as "
            "breakaway, or leave it out"
        )
    return found


def _far_stops(device: Device) -> list[str]:
    limit, radius = device.kinematics.limit, device.radius
    # Where sector and lever are as large, the joint may be a drum that turns more than once.
    slide = device.capstan.sector_radius == radius and limit * radius <= WAY
    if limit <= TURN or slide:
        return []
    return [
        f"device.kinematics.limit = {limit:g} rad: the stops lie {limit * radius:.4g} m from the middle, and edge and "
        f"end of the workspace follow from them; limit is in rad, from the middle to the stop: {limit:g} degrees are "
        f"{radians(limit):.4g} rad"
    ]


def _usual(span: tuple[float, float], unit: str) -> str:
    return f"usual are {span[0]:g} to {span[1]:g} {unit}"
