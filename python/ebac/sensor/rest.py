"""What acts on a force sensor that is to be taken as zero: no load, and a reading that is still."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import fsum, hypot, sqrt

from ebac.sensor.configuration import Row, SensorConfig, Wrench
from ebac.sensor.errors import SensorError
from ebac.sensor.reading import SensorReading

#: Range of a sensor whose range is not configured: that of the reference device [N, N m].
RANGE = (145.0, 5.0)
#: Largest load that is taken as zero, and largest standard deviation of a reading that is still, over the range.
LOAD, SPREAD = 0.05, 1e-3
#: Shortest time for which a reading is watched [s]: two periods of the tremor of a hand.
WATCH = 0.2


@dataclass(frozen=True, kw_only=True)
class Rest:
    """What a sensor read for a while, in the sensor's axes.

    Attributes
    ----------
    mean : 6 floats
        Force [N] and torque [N m], bias taken off.
    force_spread, torque_spread : float
        Standard deviation of force [N] and torque [N m], all axes together.
    """

    mean: Wrench
    force_spread: float
    torque_spread: float

    @classmethod
    def of(cls, readings: Sequence[SensorReading], config: SensorConfig) -> Rest:
        """Return mean and spread of readings; at least one."""
        force, force_spread = _mean([one.force for one in readings])
        torque, torque_spread = _mean([one.torque for one in readings])
        mean = (*_turned_back(force, config), *_turned_back(torque, config))
        return cls(mean=mean, force_spread=force_spread, torque_spread=torque_spread)

    def check(self, config: SensorConfig, *, accept_load: bool, accept_unsteady: bool) -> None:
        """Refuse to take this as zero.

        Raises
        ------
        SensorError
            For a load, or a reading that is not still, unless it is accepted.
        """
        where = f"sensor at {config.host}:{config.port}: no zero was taken: "
        spreads, loads = (self.force_spread, self.torque_spread), self._loads()
        if not accept_unsteady and (wrong := _beyond(spreads, SPREAD, config)):
            raise SensorError(
                f"{where}the reading is not still, its standard deviation is {wrong}. Take hands off the handle and "
                "wait until it is at rest; if this is the noise of the sensor, accept_unsteady=True "
                "(--accept-unsteady) takes the mean"
            )
        if not accept_load and (wrong := _beyond(loads, LOAD, config)):
            raise SensorError(
                f"{where}a load acts on the sensor, {wrong}. Take hands and tools off the handle; if only the handle "
                "and the offset of the sensor are in it, accept_load=True (--accept-load) takes it as zero"
            )

    def check_same(self, reading: SensorReading, config: SensorConfig) -> None:
        """Refuse a reading that is another than the mean, by ten times the spread of one that is still.

        Raises
        ------
        SensorError
            Then.
        """
        now = Rest.of([reading], config).mean
        apart = [a - b for a, b in zip(now, self.mean, strict=True)]
        if wrong := _beyond((hypot(*apart[:3]), hypot(*apart[3:])), 10 * SPREAD, config):
            raise SensorError(
                f"sensor at {config.host}:{config.port}: no zero was taken: the reading has changed meanwhile, by "
                f"{wrong}. Keep hands off the handle and try again"
            )

    def _loads(self) -> tuple[float, float]:
        return hypot(*self.mean[:3]), hypot(*self.mean[3:])


def _beyond(values: tuple[float, float], share: float, config: SensorConfig) -> str:
    """Return the first of force and torque that is beyond a share of its range, with the limit; else nothing."""
    given = (config.force_range, config.torque_range)
    names = (("force_range", "N"), ("torque_range", "N m"))
    for value, known, default, (name, unit) in zip(values, given, RANGE, names, strict=True):
        limit = share * (known or default)
        if value > limit:
            why = (
                f"of sensor.{name}"
                if known
                else f"of {default:g} {unit}, as sensor.{name} is not given"
            )
            return (
                f"{value:.3g} {unit}: must be at most {limit:.3g} {unit} ({100 * share:g} % {why})"
            )
    return ""


def _mean(rows: Sequence[Row]) -> tuple[Row, float]:
    n = len(rows)
    x, y, z = (fsum(axis) / n for axis in zip(*rows, strict=True))
    apart = fsum(hypot(a - x, b - y, c - z) ** 2 for a, b, c in rows)
    return (x, y, z), sqrt(apart / n)


def _turned_back(handle: Row, config: SensorConfig) -> Row:
    """Return a vector of the handle's axes in the sensor's: the rotation is orthonormal."""
    x, y, z = (
        config.sign
        * fsum(row[i] * value for row, value in zip(config.rotation, handle, strict=True))
        for i in range(3)
    )
    return (x, y, z)
