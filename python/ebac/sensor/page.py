"""The page `/netftapi2.xml` of a sensor: its model and the scaling of its counts."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from ebac.sensor.errors import SensorError

PAGE = "/netftapi2.xml"
#: A page of a sensor has some 10 kB.
_MOST = 1_000_000

#: Newtons of one unit, and newton metres, by their names on the page without dashes and in lower case.
_FORCE = {
    "n": 1.0,
    "kn": 1e3,
    "lbf": 4.4482216152605,
    "klbf": 4448.2216152605,
    "kg": 9.80665,
    "kgf": 9.80665,
    "g": 9.80665e-3,
}
_TORQUE = {
    "nm": 1.0,
    "nmm": 1e-3,
    "knm": 1e3,
    "lbfin": 0.1129848290276167,
    "lbfft": 1.3558179483314004,
    "kgcm": 9.80665e-2,
    "kgfcm": 9.80665e-2,
}


@dataclass(frozen=True, kw_only=True)
class SensorPage:
    """Contents of the page of a sensor.

    Attributes
    ----------
    counts_per_force, counts_per_torque : float
        Counts of 1 N and of 1 N m, whatever the sensor's own units.
    force_unit, torque_unit : str
        Its own units.
    product, serial : str
        Its name and number; empty where the page has none.
    rate : float or None
        Records a second it is set to [Hz].
    streams : bool or None
        Whether RDT is switched on.
    """

    counts_per_force: float
    counts_per_torque: float
    force_unit: str
    torque_unit: str
    product: str = ""
    serial: str = ""
    rate: float | None = None
    streams: bool | None = None


def read_page(host: str, *, http_port: int = 80, timeout: float = 2.0) -> SensorPage:
    """Read the page of a sensor.

    Parameters
    ----------
    host : str
        IPv4 address or name.
    http_port : int
        Its port for HTTP, 1 to 65535.
    timeout : float
        Longest wait for each answer [s], above 0.

    Raises
    ------
    SensorError
        When it cannot be had, or does not contain the scaling of the counts.
    ValueError
        For a port or time that cannot be.
    """
    if not 1 <= http_port <= 65535:
        raise ValueError(f"sensor.http_port = {http_port}: must lie in [1, 65535]")
    if not (timeout > 0 and isfinite(timeout)):
        raise ValueError(f"sensor.timeout = {timeout} s: must be above 0 s")
    where = f"http://{host}:{http_port}{PAGE}"
    return parse_page(_fetch(where, timeout), where)


def parse_page(text: bytes, where: str = "page") -> SensorPage:
    """Parse the text of a page.

    Raises
    ------
    SensorError
        When it is no page of a sensor, or a value of it cannot be.
    """
    from xml.etree import ElementTree

    try:
        if b"<!doctype" in text.lower():  # a document that defines words of its own could grow
            raise ElementTree.ParseError("it has a document type")
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise SensorError(
            f"{where}: is no XML ({error}); is this the address of a sensor?"
        ) from None
    found = {
        str(item.tag).rpartition("}")[2].lower(): (item.text or "").strip() for item in root.iter()
    }
    force = _unit(found, "scfgfu", _FORCE, where)
    torque = _unit(found, "scfgtu", _TORQUE, where)
    rate = found.get("comrdtrate", "")
    streams = found.get("comrdte", "").lower()
    return SensorPage(
        counts_per_force=_counts(found, "cfgcpf", where) / force,
        counts_per_torque=_counts(found, "cfgcpt", where) / torque,
        force_unit=found["scfgfu"],
        torque_unit=found["scfgtu"],
        product=found.get("prodname", ""),
        serial=found.get("setserial", ""),
        rate=float(rate) if rate.isdecimal() else None,
        streams=streams in ("enabled", "1") if streams else None,
    )


def _fetch(where: str, timeout: float) -> bytes:
    import http.client
    import urllib.error
    import urllib.request

    # The sensor stands beside this machine: no proxy is between.
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    try:
        with opener.open(where, timeout=timeout) as answer:
            text = bytes(answer.read(_MOST + 1))
    except urllib.error.HTTPError as error:
        raise SensorError(
            f"{where}: answers {error.code} ({error.reason}); is this the address of a sensor?"
        ) from None
    except (OSError, http.client.HTTPException, ValueError) as error:
        reason = getattr(error, "reason", error) or type(error).__name__
        raise SensorError(
            f"{where}: cannot be read ({reason}); check its power, cable and address, or give "
            "counts_per_force and counts_per_torque from its calibration sheet"
        ) from None
    if len(text) > _MOST:
        raise SensorError(f"{where}: is longer than {_MOST:,} bytes; no page of a sensor is")
    return text


def _unit(found: dict[str, str], tag: str, known: dict[str, float], where: str) -> float:
    if tag not in found:
        raise SensorError(
            f"{where}: has no <{tag}>, the unit of its counts; it is no page of a Net F/T"
        )
    name = found[tag]
    short = "".join(letter for letter in name.lower() if letter.isalpha())
    if short not in known:
        raise SensorError(
            f"{where}: <{tag}> = {name!r} is no unit known here; there are: {', '.join(known)}. Set the "
            "sensor to N and N-m on its own pages"
        )
    return known[short]


def _counts(found: dict[str, str], tag: str, where: str) -> float:
    text = found.get(tag, "")
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not (value > 0 and isfinite(value)):
        raise SensorError(
            f"{where}: <{tag}> = {text!r}: must be a number above 0, counts of a unit"
        )
    return value
