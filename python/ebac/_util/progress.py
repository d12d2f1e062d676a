"""How far a piece of work is."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

#: Called with how much is done, and of how much.
Progress: TypeAlias = Callable[[int, int], None]
