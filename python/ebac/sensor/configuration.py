"""Where a force sensor is, what its counts are worth, and how it sits in the handle."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import inf, isfinite
from typing import Any, Self, TypeAlias

from ebac import _core
from ebac._util.arguments import nearest_float, plain, unknown
from ebac._util.at_user import warn
from ebac._util.wrong_calls import plain_constructor
from ebac.sensor.status import BITS

Row: TypeAlias = tuple[float, float, float]
Rotation: TypeAlias = tuple[Row, Row, Row]
#: A force [N] and a torque [N m] together.
Wrench: TypeAlias = tuple[float, float, float, float, float, float]

#: Models by name.
MODELS = dict(zip(BITS, _core.SensorModel, strict=True))
#: Share by which counts may differ from those on the sensor's page, which are rounded.
_SAME_SCALE = 1e-3
#: Parameters that the core checks as a scale.
_SCALE = ("counts_per_force", "counts_per_torque", "force_range", "torque_range")


def _within(low: float = -inf, high: float = inf, unit: str = "1") -> dict[str, Any]:
    """Return range and unit of a field, for lists of keys; what is given is checked by the core."""
    return {"low": low, "high": high, "unit": unit}


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class SensorConfig:
    """A force/torque sensor on the network and its place in the handle.

    Parameters
    ----------
    host : str
        IPv4 address or name; a Net F/T leaves the factory with 192.168.1.1.
    port : int
        UDP port, 1 to 65535.
    model : "net-ft", "axia" or "other"
        Whose status bits it has; with "other" every bit is an error.
    counts_per_force, counts_per_torque : float
        Counts of 1 N and of 1 N m, 1e-3 to 1e12. A sensor's own page contains them: `read_page`.
    force_range, torque_range : float
        A force [N] or torque [N m] along one of its axes that large is saturated whatever its status
        says, 0 to 1e6; 0 trusts the status.
    rotation : 3 rows of 3
        Rotates from the sensor's axes to the handle's, which are those of the ports:
        handle = rotation @ sensor. Orthonormal within 1e-6 and no mirror.
    sign : 1 or -1
        1 where the sensor shows the force of the hand on the handle, -1 for the opposite.
    bias : 6 floats
        What is taken as zero, in the sensor's axes: force [N], torque [N m].
    http_port : int
        Port of the sensor's own page, whose counts are compared with these before a run, 1 to 65535; 0 for a sensor
        without a page.
    retry : float
        Silence after which the stream is asked for again [s], 1e-3 to 60.
    gone : float
        Silence after which the sensor counts as disconnected [s], 1e-3 to 60.

    Raises
    ------
    ValueError
        When a value is out of its range; the message has its name, unit and range.
    TypeError
        When a value is of a wrong type.
    """

    host: str = "192.168.1.1"
    port: int = field(default=49152, metadata=_within(1, 65535))
    model: str = "net-ft"
    counts_per_force: float = field(default=1e6, metadata=_within(1e-3, 1e12, "counts/N"))
    counts_per_torque: float = field(default=1e6, metadata=_within(1e-3, 1e12, "counts/(N m)"))
    force_range: float = field(default=0.0, metadata=_within(0.0, 1e6, "N"))
    torque_range: float = field(default=0.0, metadata=_within(0.0, 1e6, "N m"))
    rotation: Rotation = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    sign: int = 1
    bias: Wrench = field(default=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), metadata=_within(unit="N, N m"))
    http_port: int = field(default=80, metadata=_within(0, 65535))
    retry: float = field(default=0.25, metadata=_within(1e-3, 60.0, "s"))
    gone: float = field(default=0.5, metadata=_within(1e-3, 60.0, "s"))

    def __post_init__(self) -> None:
        """Check types and ranges; the core checks what it owns."""
        for one in dataclasses.fields(self):
            object.__setattr__(self, one.name, plain(getattr(self, one.name)))
        host: Any = self.host
        if not isinstance(host, str) or not host.strip():
            raise TypeError(
                f"sensor.host = {host!r}: must be an address or a name, as '192.168.1.1'"
            )
        for name in ("port", "sign", "http_port"):
            value = getattr(self, name)
            if not isinstance(value, int) or isinstance(value, bool):
                raise TypeError(f"sensor.{name} = {value!r}: must be a whole number")
        for name, low in (("port", 1), ("http_port", 0)):
            if not low <= getattr(self, name) <= 65535:
                raise ValueError(
                    f"sensor.{name} = {getattr(self, name)}: must lie in [{low}, 65535]"
                )
        if self.sign not in (-1, 1):
            raise ValueError(
                f"sensor.sign = {self.sign}: must be 1 (force of the hand on the handle) or -1"
            )
        if self.model not in MODELS:
            raise ValueError(unknown(f"sensor.model = {self.model!r}", self.model, MODELS))
        rows = numbers("rotation", self.rotation, 3, inner=3)
        object.__setattr__(self, "rotation", rows)
        object.__setattr__(self, "bias", numbers("bias", self.bias, 6))
        _core._check_sensor(
            self.port, nearest_float(self.retry), nearest_float(self.gone), self._flat(), self.sign
        )
        self._scale()

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some parameters changed."""
        return dataclasses.replace(self, **changes)

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """Return the sensor that a table of TOML describes; what is not named keeps its default.

        Raises
        ------
        ValueError
            For an unknown name, a wrong type or a value out of range.
        """
        from ebac._util.misplaced import misplaced
        from ebac._util.serialisation import read_table

        path = ("sensor",)
        try:
            return cls(**read_table(table, dataclasses.fields(cls), path))
        except (ValueError, TypeError) as error:
            raise misplaced(path, table, error) from None

    def check_scale(self, *, timeout: float = 1.0) -> None:
        """Compare the counts with those on the sensor's own page; nothing where `http_port` is 0.

        Parameters
        ----------
        timeout : float
            Longest wait for the page [s], above 0.

        Warns
        -----
        UserWarning
            When the page cannot be read: nothing was compared.

        Raises
        ------
        SensorError
            When they differ by more than 0.1 %: every force would be wrong.
        """
        from ebac.sensor.errors import SensorError
        from ebac.sensor.page import read_page

        if self.http_port == 0:
            return
        try:
            page = read_page(self.host, http_port=self.http_port, timeout=timeout)
        except SensorError as error:
            warn(
                f"the counts of the force sensor were not compared with its own page: {error}; "
                "sensor.http_port = 0 for a sensor without a page"
            )
            return
        for name in ("counts_per_force", "counts_per_torque"):
            mine, own = float(getattr(self, name)), float(getattr(page, name))
            if abs(mine - own) > _SAME_SCALE * own:
                raise SensorError(
                    f"sensor.{name} = {mine:g}: the page of the sensor at {self.host} has {own:g}, "
                    "and every force would be wrong by that; correct the configuration, or the sensor's "
                    "active calibration"
                )

    def core(self) -> _core.RdtSetup:
        """Return it as the core takes it; a name is looked up now.

        Raises
        ------
        ValueError
            When there is no such host.
        """
        counts = (self.counts_per_force,) * 3 + (self.counts_per_torque,) * 3
        return _core.RdtSetup(
            self.host,
            self.port,
            scale=self._scale(),
            rotation=self._flat(),
            sign=self.sign,
            model=MODELS[self.model],
            retry=self.retry,
            gone=self.gone,
            bias=[value * scale for value, scale in zip(self.bias, counts, strict=True)],
        )

    def _scale(self) -> _core.FtScale:
        try:
            return _core.FtScale(**{name: getattr(self, name) for name in _SCALE})
        except (TypeError, ValueError) as error:
            raise type(error)(str(error).replace("FtScale.", "sensor.")) from None

    def _flat(self) -> list[float]:
        return [value for row in self.rotation for value in row]


def numbers(name: str, given: Any, count: int, *, inner: int = 0) -> tuple[Any, ...]:
    """Return rows of finite numbers as tuples, or raise an error that names what is wrong."""
    shape = f"{count} rows of {inner} numbers" if inner else f"{count} numbers"
    if not isinstance(given, Sequence) or isinstance(given, str) or len(given) != count:
        given = given.tolist() if hasattr(given, "tolist") else given
    if not isinstance(given, Sequence) or isinstance(given, str) or len(given) != count:
        raise TypeError(f"sensor.{name} = {given!r}: must be {shape}")
    if inner:
        return tuple(numbers(name, row, inner) for row in given)
    for value in map(plain, given):
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise TypeError(f"sensor.{name} has {value!r}: must be {shape}")
        if not isfinite(value):
            raise ValueError(f"sensor.{name} has {value!r}: must be finite")
    return tuple(float(value) for value in given)
