"""Numbers with their nouns."""

from __future__ import annotations


def plural(count: int, one: str, many: str = "") -> str:
    """Return a number with its noun: 1 axis, 2 axes."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"
