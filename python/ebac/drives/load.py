"""Worst-case load of a CAN bus, before anything runs on it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf

from ebac._core import REFUSED_LOAD, WARNED_LOAD
from ebac.drives.frame_length import frame_bits

#: Bit rates of CiA 301 [bit/s].
BITRATES = (10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000, 800_000, 1_000_000)


@dataclass(frozen=True, kw_only=True)
class Traffic:
    """One frame that comes again and again.

    Parameters
    ----------
    name : str
        What it is, for people.
    size : int
        Data [bytes], 0 to 8.
    rate : float
        How often it comes, at most [Hz], at least 0.

    Raises
    ------
    ValueError
        For a size or a rate out of range.
    """

    name: str
    size: int
    rate: float

    def __post_init__(self) -> None:
        """Check size and rate."""
        if self.size not in range(9):
            raise ValueError(f"{self.name}: size = {self.size} bytes: must lie in [0, 8] bytes")
        if not 0 <= self.rate < inf:
            raise ValueError(f"{self.name}: rate = {self.rate:g} Hz: must be finite, at least 0 Hz")

    @property
    def bits(self) -> int:
        """Bits of one frame on the wire, worst case."""
        return frame_bits(self.size)


@dataclass(frozen=True, kw_only=True)
class BusLoad:
    """What the planned frames take of a bus.

    Parameters
    ----------
    traffic : tuple of Traffic
        The frames.
    bitrate : int
        Of the bus [bit/s].
    """

    traffic: tuple[Traffic, ...]
    bitrate: int

    @property
    def share(self) -> float:
        """Share of the bus, 0 to 1 and beyond."""
        return sum(one.bits * one.rate for one in self.traffic) / self.bitrate

    @property
    def refused(self) -> bool:
        """Whether it leaves no room for SDO, EMCY and repetitions: over 90 %."""
        return self.share > REFUSED_LOAD

    @property
    def warned(self) -> bool:
        """Whether it is more than is comfortable: over 70 %."""
        return self.share > WARNED_LOAD

    def describe(self) -> str:
        """Return it in one sentence."""
        text = f"bus load {100 * self.share:.0f} % of {self.bitrate / 1000:g} kbit/s, worst case"
        if self.refused:
            return f"{text}: refused over {100 * REFUSED_LOAD:.0f} %; {_REMEDY}"
        if self.warned:
            return f"{text}: more than {100 * WARNED_LOAD:.0f} % is a warning; {_REMEDY}"
        return text


_REMEDY = "raise the bit rate, lengthen sync.period, map fewer objects, or use a second bus"


def bus_load(traffic: Iterable[Traffic], *, bitrate: int) -> BusLoad:
    """Return the worst-case load of a bus by frames that come again and again.

    Parameters
    ----------
    traffic : iterable of Traffic
        Frames and their rates.
    bitrate : int
        Of the bus [bit/s], 10 000 to 1 000 000.

    Raises
    ------
    ValueError
        When the bit rate is none of CiA 301.
    """
    if bitrate not in BITRATES:
        rates = ", ".join(str(rate) for rate in BITRATES)
        raise ValueError(f"bitrate = {bitrate} bit/s: must be one of {rates} bit/s")
    return BusLoad(traffic=tuple(traffic), bitrate=bitrate)
