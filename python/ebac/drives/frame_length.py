"""Length of a CAN frame on the wire: at most, or of one frame with its stuff bits."""

from __future__ import annotations

from ebac._core import _exact_bits, least_bits, worst_bits

__all__ = ["exact_bits", "frame_bits", "least_bits"]


def frame_bits(size: int) -> int:
    """Return the bits of a classical CAN frame with `size` bytes, stuffed as badly as can be.

    47 bits frame it (11-bit identifier, interframe space included); one stuff bit may follow
    every four of the 34 + 8 n bits that are stuffed (ISO 11898-1; Davis et al. 2007, eq. 1).

    Parameters
    ----------
    size : int
        Data of the frame [bytes], 0 to 8.

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
    return _exact_bits(cob_id, data, remote, length)
