"""Faults of drives: emergency codes and the latched faults of Copley drives."""

from __future__ import annotations

from collections.abc import Callable, Sequence

#: Bits of 0x2183, latched faults (Copley): name, what to check.
LATCHED: tuple[tuple[int, str, str], ...] = (
    (0, "data flash corrupt", "return the drive or load its firmware again"),
    (1, "drive internal error", "return the drive"),
    (2, "short circuit", "check motor cable and winding"),
    (3, "drive over temperature", "let it cool; check airflow and current limits"),
    (4, "motor over temperature", "let it cool; check the continuous torque"),
    (5, "over voltage", "the motor feeds back while braking: check supply and regeneration"),
    (6, "under voltage", "check the supply and its current limit"),
    (7, "feedback fault", "check the encoder's cable and supply"),
    (8, "phasing error", "check Hall sensors and motor wiring"),
    (9, "following error", "check for a blocked axis; raise the window"),
    (10, "current limited by i2t", "the torque asked is above what the motor holds for long"),
    (11, "FPGA failure", "return the drive or load its firmware again"),
    (12, "command input lost", "check heartbeat, SYNC and the cable"),
    (13, "FPGA failure", "return the drive or load its firmware again"),
    (14, "safety circuit fault", "check the safe-torque-off wiring"),
    (15, "current cannot be controlled", "check motor cable and current loop gains"),
    (16, "motor wiring disconnected", "check the motor connector"),
)

#: First byte of an emergency code, or the whole code: meaning (CiA 301, CiA 402-2).
EMERGENCIES: dict[int, str] = {
    0x0000: "error reset or no error",
    0x1000: "generic error",
    0x2000: "current",
    0x2300: "current, output side",
    0x2310: "continuous over current",
    0x2320: "short circuit",
    0x2350: "i2t limit of the motor",
    0x3000: "voltage",
    0x3110: "mains over voltage",
    0x3120: "mains under voltage",
    0x3210: "over voltage",
    0x3220: "under voltage",
    0x4000: "temperature",
    0x4210: "drive over temperature",
    0x4310: "motor over temperature",
    0x5000: "hardware",
    0x6000: "software",
    0x7000: "additional modules",
    0x7300: "sensor",
    0x7305: "encoder 1",
    0x8000: "monitoring",
    0x8110: "CAN overrun",
    0x8120: "CAN error passive",
    0x8130: "heartbeat or node guarding lost",
    0x8140: "recovered from bus off",
    0x8210: "PDO too short",
    0x8611: "following error",
    0x9000: "external error",
    0xF000: "additional functions",
    0xFF00: "specific to the maker",
}


def latched(word: int) -> list[str]:
    """Return the names of the latched faults in 0x2183, each with what to check."""
    return named_bits(word, [f"{name} ({check})" for _, name, check in LATCHED])


#: Bits of 0x1001, error register (CiA 301).
ERRORS = (
    "generic",
    "current",
    "voltage",
    "temperature",
    "communication",
    "of the profile",
    "",
    "of the maker",
)
#: Bits of 0x6502, supported modes (CiA 402-2).
MODES = (
    *(
        "profile position",
        "velocity",
        "profile velocity",
        "torque",
        "",
        "homing",
        "interpolated position",
    ),
    *("cyclic position", "cyclic velocity", "cyclic torque"),
)


def named_bits(word: int, names: Sequence[str]) -> list[str]:
    """Return the names of the bits that are set, from bit 0 on; those without a name as one number."""
    known = sum(1 << bit for bit, name in enumerate(names) if name)
    named = [name for bit, name in enumerate(names) if name and word >> bit & 1]
    return [*named, f"unknown bits 0x{word & ~known:X}"] if word & ~known else named


#: What the bits of an object mean, by its name.
BITS: dict[str, Callable[[int], list[str]]] = {
    "latched_faults": latched,
    "error_register": lambda word: named_bits(word, ERRORS),
    "supported_modes": lambda word: named_bits(word, MODES),
    "error_code": lambda code: [emergency(code)],
}


def emergency(code: int) -> str:
    """Return what an emergency code means; that of its family where it is not known itself."""
    for mask in (0xFFFF, 0xFFF0, 0xFF00, 0xF000):
        if code & mask in EMERGENCIES and (code & mask or code == 0 or mask == 0xFF00):
            return EMERGENCIES[code & mask]
    return "unknown"
