"""Runs of many hands that are too short to judge a contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.scenario import Scenario


def note(base: Scenario) -> None:
    """Say on stderr that runs so short say nothing of a law: their hands have not settled and are not good."""
    from ebac._util.verdicts import JUDGED_FROM

    if base.seconds < JUDGED_FROM:
        output.note(
            f"--seconds = {base.seconds:g} s: too short to judge a contact, which takes {JUDGED_FROM:g} s or more; "
            "hands that have not settled count as not good"
        )
