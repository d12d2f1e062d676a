"""Runs that are too short to judge a contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac._util.verdicts import JUDGED_FROM

if TYPE_CHECKING:
    from ebac.scenario import Scenario


def of_many(base: Scenario, name: str = "Scenario.seconds") -> str:
    """Return that runs so short say nothing of a law, as their hands have not settled and are not good; else nothing.

    `name` is what gives their length.
    """
    if base.seconds >= JUDGED_FROM:
        return ""
    return (
        f"{name} = {base.seconds:g} s: too short to judge a contact, which takes {JUDGED_FROM:g} s or more; "
        "hands that have not settled count as not good"
    )
