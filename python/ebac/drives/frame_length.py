"""Length of a CAN frame on the wire: at most, or of one frame with its stuff bits."""

from __future__ import annotations

from ebac._core import worst_bits

#: CRC-15 of CAN (ISO 11898-1), and the bits that are never stuffed: delimiters, ACK, end, interframe space.
_POLYNOMIAL, _FIXED = 0x4599, 1 + 2 + 7 + 3


def frame_bits(size: int) -> int:
    """Return the bits of a classical CAN frame with `size` bytes, stuffed as badly as can be.

    47 bits frame it (11-bit identifier, interframe space included); one stuff bit may follow
    every four of the 34 + 8 n bits that are stuffed (ISO 11898-1; Davis et al. 2007, eq. 1).

    Raises
    ------
    ValueError
        When `size` is not in [0, 8].
    """
    if not 0 <= size <= 8:
        raise ValueError(f"size = {size} bytes: a classical CAN frame has 0 to 8")
    return worst_bits(size)


def exact_bits(
    cob_id: int, data: bytes = b"", *, remote: bool = False, size: int | None = None
) -> int:
    """Return the bits of a classical CAN frame with an 11-bit identifier, stuff bits and interframe space included.

    Parameters
    ----------
    cob_id : int
        Identifier, 0 to 0x7FF.
    data : bytes
        At most 8.
    remote : bool
        A remote frame: no data, `size` as its length code.
    size : int, optional
        Length code of a remote frame, 0 to 8.

    Raises
    ------
    ValueError
        For an identifier or a length that no such frame has.
    """
    length = len(data) if size is None else size
    if not 0 <= cob_id <= 0x7FF or not 0 <= length <= 8 or (data and remote):
        raise ValueError(
            f"frame 0x{cob_id:X} with {length} bytes: must be at most 0x7FF with at most 8 bytes"
        )
    # start of frame, identifier, RTR, IDE, r0, length code, data
    word, bits = (cob_id << 7) | (int(remote) << 6) | length, 1 + 11 + 3 + 4
    for byte in data:
        word, bits = word << 8 | byte, bits + 8
    word, bits = word << 15 | crc15(word, bits), bits + 15
    return bits + _stuffed(word, bits) + _FIXED


def crc15(word: int, bits: int) -> int:
    """Return the CRC-15 of CAN over the lowest `bits` bits of a number, the highest first."""
    crc = 0
    for at in range(bits - 1, -1, -1):
        top = crc >> 14 & 1 ^ word >> at & 1
        crc = (crc << 1 & 0x7FFF) ^ (_POLYNOMIAL if top else 0)
    return crc


def _stuffed(word: int, bits: int) -> int:
    """Return the stuff bits: one of the other value after every five alike, which counts for the next five."""
    count, run, last = 0, 0, None
    for at in range(bits - 1, -1, -1):
        bit = word >> at & 1
        run = run + 1 if bit == last else 1
        last = bit
        if run == 5:
            count, run, last = count + 1, 1, 1 - bit
    return count
