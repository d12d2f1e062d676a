"""The same plant, step and wall in other programs, and what they do and do not do."""

from ebac.peers.compare import NOTES, compare
from ebac.peers.row import PeerRow, program

__all__ = ["NOTES", "PeerRow", "compare", "program"]


def __dir__() -> list[str]:
    return __all__
