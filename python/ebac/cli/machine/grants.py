"""What threads asked of the system and did not get, for people."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ebac.cli import output

if TYPE_CHECKING:
    from ebac._core import Grant


def show_refused(grants: Sequence[Grant]) -> None:
    """Print each that was not granted, and the command that would grant it: the first of its kind grants the others."""
    shown: set[str] = set()
    for grant in grants:
        if grant.granted:
            continue
        output.say(f"{grant.name}: {grant.asked}, not granted ({grant.why})", style="yellow")
        kind = grant.name.partition(" ")[0]
        if kind not in shown:
            output.indented(grant.remedy)
        shown.add(kind)
