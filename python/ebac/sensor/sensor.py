"""A force sensor on the network, read from Python."""

from __future__ import annotations

import dataclasses
import time
from types import TracebackType
from typing import Any, Self

from ebac._core import LinkState, RdtClient, SensorStatus
from ebac._util.arguments import require
from ebac._util.wrong_calls import plain_constructor
from ebac.sensor.configuration import SensorConfig, Wrench
from ebac.sensor.errors import SensorError, silence
from ebac.sensor.reading import SensorCounts, SensorReading
from ebac.sensor.rest import WATCH, Rest

#: A record that waited longer [s] is not what acts now: another one is under way.
_OLD = 0.02
#: Most records of a mean.
MOST_RECORDS = 1_000_000


@plain_constructor
class Sensor:
    """A force/torque sensor that streams to this program. A context manager; see `open`.

    Only the newest record matters: what came between two calls is counted and passed over. The system
    keeps some 250 for a program that does not read; more than that are lost, and counted as lost.
    """

    def __init__(self, config: SensorConfig) -> None:
        require(config, SensorConfig, "ebac.sensor.Sensor", "a SensorConfig")
        self.config = config
        self._client = RdtClient(config.core())
        self._earlier = dict.fromkeys(SensorCounts.__dataclass_fields__, 0)  # of streams before

    @classmethod
    def open(
        cls, config: SensorConfig | None = None, *, timeout: float = 2.0, **changes: Any
    ) -> Self:
        """Start the stream of a sensor and wait for its first record.

        Parameters
        ----------
        config : SensorConfig, optional
            Default: a Net F/T as it leaves the factory.
        timeout : float
            Longest wait for the first record [s], 0 to 3600.
        **changes
            Parameters of `SensorConfig` to set on top.

        Raises
        ------
        SensorError
            When no record came; the message names the reason and what to check.
        ValueError, TypeError
            For a configuration that cannot be.

        Examples
        --------
        >>> with Sensor.open(host="192.168.1.1") as sensor:  # doctest: +SKIP
        ...     sensor.bias()
        ...     print(sensor.read().force)
        """
        config = config or SensorConfig()
        sensor = cls(config.replace(**changes) if changes else config)
        try:
            sensor._client.start()
            sensor.read(timeout=timeout)
        except BaseException:
            sensor.close()
            raise
        return sensor

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the stream."""
        self._client.close()

    @property
    def state(self) -> LinkState:
        """How the way to the sensor stands, as of the last read."""
        return self._client.state

    @property
    def counts(self) -> SensorCounts:
        """What came and what did not, as of the last read."""
        return SensorCounts(
            **{name: n + getattr(self._client, name) for name, n in self._earlier.items()}
        )

    @property
    def latest(self) -> SensorReading:
        """The newest record that is here, however old; waits for nothing."""
        self._client.poll(0.0)
        return self._reading()

    def read(self, timeout: float = 1.0) -> SensorReading:
        """Return the newest record, after waiting for one that is newer than the last.

        Parameters
        ----------
        timeout : float
            Longest wait [s], 0 to 3600.

        Raises
        ------
        SensorError
            When none came.
        """
        newer = self._client.poll(timeout)
        if newer and self._client.age > _OLD:  # the queue ran over while nobody read
            newer = self._client.poll(timeout)
        if not newer:
            raise silence(self.config.host, self.config.port, self._client.state, timeout)
        return self._reading()

    def rest(self, records: int = 200, *, timeout: float = 1.0) -> Rest:
        """Return mean and spread of what acts, until so many records have come and for 0.2 s at least.

        Parameters
        ----------
        records : int
            How many, 1 to 1e6. Good ones count, and of those that come between two looks the newest.
        timeout : float
            Longest wait for each good record [s].

        Raises
        ------
        SensorError
            When no good record came.
        ValueError
            For a number of records out of range.
        """
        if not 1 <= records <= MOST_RECORDS:
            raise ValueError(f"records = {records}: must lie in [1, {MOST_RECORDS}]")
        readings: list[SensorReading] = []
        before = self._client.received
        end = time.monotonic() + WATCH
        while self._client.received - before < records or time.monotonic() < end:
            readings.append(self._good(timeout))
        return Rest.of(readings, self.config)

    def bias(
        self,
        records: int = 200,
        *,
        timeout: float = 1.0,
        accept_load: bool = False,
        accept_unsteady: bool = False,
    ) -> Wrench:
        """Take the mean of the next good records as zero, here and from now on.

        Nobody may touch the handle meanwhile. What acts is first watched for as many records, and for 0.2 s at least.
        Saturated records and those with an error do not count.

        Parameters
        ----------
        records : int
            How many, 1 to 1e6.
        timeout : float
            Longest wait for each good record [s].
        accept_load : bool
            Take a force or torque as zero that is more than 5 % of the range, `SensorConfig.force_range` and
            `torque_range`; where these are 0, of 145 N and 5 N m.
        accept_unsteady : bool
            Take the mean of a reading as zero that is not still: its standard deviation is more than 0.1 % of the
            range.

        Returns
        -------
        6 floats
            Force [N] and torque [N m] in the sensor's axes, for `SensorConfig.bias`.

        Raises
        ------
        SensorError
            When no good record came, and for a load or a reading that is not still; the message has the value and its
            limit. The bias is then what it was.
        ValueError
            For a number of records out of range.
        """
        found = self.rest(records, timeout=timeout)
        found.check(self.config, accept_load=accept_load, accept_unsteady=accept_unsteady)
        self._client.begin_bias(records)
        try:
            while self._biasing():
                reading = self._good(timeout)
                if self._biasing() and not accept_unsteady:
                    found.check_same(reading, self.config)
        finally:
            self._client.cancel_bias()  # or the zero would change later, when good records come again
        return self._bias()

    def bias_inside(
        self,
        records: int = 200,
        *,
        timeout: float = 1.0,
        accept_load: bool = False,
        accept_unsteady: bool = False,
    ) -> None:
        """Have the sensor itself take what acts now as zero (software bias).

        It holds for every program, until the sensor loses its power. Nothing answers: see the next reading. Parameters
        and errors are those of `bias`; what acts is watched first. A zero that was taken here, or `SensorConfig.bias`,
        does not count for the load, and is 0 from then on.
        """
        found = self.rest(records, timeout=timeout)
        here = self._bias()
        load: Any = tuple(left + zero for left, zero in zip(found.mean, here, strict=True))
        whole = dataclasses.replace(found, mean=load)
        whole.check(self.config, accept_load=accept_load, accept_unsteady=accept_unsteady)
        self._client.bias_sensor()
        if any(here):
            self._begin_without_zero(timeout)

    def _begin_without_zero(self, timeout: float) -> None:
        """Begin the stream anew with nothing taken off here: a client of the core keeps its zero."""
        config = self.config.replace(bias=(0.0,) * 6)
        client = RdtClient(config.core())
        self._earlier = self.counts.row()
        self._client.close()
        self.config, self._client = config, client
        self._client.start()
        self.read(timeout)

    def _biasing(self) -> bool:
        """Whether the zero has not yet been taken."""
        return self._client.biasing

    def _good(self, timeout: float) -> SensorReading:
        """Return the next good record; the wait for it is limited, as that for each record."""
        end = time.monotonic() + timeout
        while True:
            reading = self.read(timeout)
            if reading.health is SensorStatus.GOOD:
                return reading
            if time.monotonic() > end:
                raise SensorError(self._not_good(reading))

    def _not_good(self, reading: SensorReading) -> str:
        from ebac.sensor.status import explain

        what = "; ".join(explain(reading.status, self.config.model)) or "at the end of its range"
        return (
            f"sensor at {self.config.host}:{self.config.port}: no good record to take as zero, status "
            f"0x{reading.status:08X} ({what}); take the load off, or see its manual"
        )

    def _bias(self) -> Wrench:
        force, torque = self.config.counts_per_force, self.config.counts_per_torque
        a, b, c, d, e, f = self._client.bias
        return (a / force, b / force, c / force, d / torque, e / torque, f / torque)

    def _reading(self) -> SensorReading:
        client = self._client
        x, y, z = client.force
        tx, ty, tz = client.torque
        return SensorReading(
            force=(x, y, z),
            torque=(tx, ty, tz),
            age=client.age,
            health=client.health,
            status=client.status,
            rdt_sequence=client.rdt_sequence,
            ft_sequence=client.ft_sequence,
        )
