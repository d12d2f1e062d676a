"""What the status bits of a sensor mean.

Sources: ATI's manuals of the Net F/T (9620-05-NET FT, system status code) and of the Ethernet Axia
(9610-05-Ethernet Axia, table 4.7).
"""

from __future__ import annotations

from ebac._util.arguments import unknown

_NET_FT = {
    31: "an error",
    30: "CPU or RAM error",
    29: "digital board error",
    28: "analog board error",
    27: "serial link error",
    26: "program memory error",
    25: "halted by a configuration error",
    24: "settings are not valid",
    23: "configuration does not fit the calibration",
    22: "network failure",
    21: "CAN error",
    20: "RDT error",
    19: "EtherNet/IP failure",
    18: "DeviceNet failure",
    17: "saturated, or a converter's error",
    16: "a monitor condition was met",
    14: "watchdog",
    13: "stack error",
    12: "serial EEPROM failure",
    11: "serial flash failure",
    10: "watchdog of the analog board",
    9: "too much current through the strain gages",
    8: "too little current through the strain gages",
    7: "analog ground out of range",
    6: "supply of the analog board too high",
    5: "supply of the analog board too low",
    4: "no data on the serial link",
    3: "reference voltage or supply error",
    2: "temperature out of range",
    1: "HTTP failure",
}
_AXIA = {
    31: "an error",
    30: "force or torque out of range",
    29: "calibration has a wrong checksum",
    28: "a simulated error",
    27: "a strain gage is out of range",
    16: "a monitor condition was met",
    7: "calibration cannot be read",
    5: "another error",
    3: "busy",
    2: "a strain gage is broken",
    1: "supply voltage out of range",
    0: "temperature out of range",
}
#: Meaning of the bits by the name of the model.
BITS: dict[str, dict[int, str]] = {"net-ft": _NET_FT, "axia": _AXIA, "other": {}}


def explain(status: int, model: str = "net-ft") -> list[str]:
    """Return the meanings of the bits of a status, the most specific first.

    Parameters
    ----------
    status : int
        Status word of a record, 0 to 0xFFFFFFFF; 0 is well.
    model : "net-ft", "axia" or "other"
        Whose bits they are; "other" has no names.

    Raises
    ------
    ValueError
        For a model that is not known, or a status out of range.
    """
    if model not in BITS:
        raise ValueError(unknown(f"model {model!r}", str(model), list(BITS), "model"))
    if not 0 <= status <= 0xFFFFFFFF:
        raise ValueError(f"status = {status}: must lie in [0, 0xFFFFFFFF]")
    names = BITS[model]
    bits = [i for i in range(31, -1, -1) if status >> i & 1]
    if len(bits) > 1 and 31 in bits and 31 in names:
        bits.remove(31)  # only means that another is set
    return [names.get(bit, f"bit {bit}") for bit in bits]
