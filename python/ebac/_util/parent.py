"""The process that started this one: noted as early as the package is imported, as it may die before anything runs."""

from __future__ import annotations

import os

_started_by = os.getppid()


def _note() -> None:
    global _started_by
    _started_by = os.getppid()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_note)


def parent_gone() -> bool:
    """Return whether it has died: another process has taken its children over."""
    return os.getppid() != _started_by
