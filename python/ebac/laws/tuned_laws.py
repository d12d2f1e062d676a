"""Laws with the parameters that `ebac tune` found, by names such as "tca-damped-tuned"."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ebac.laws import AnyLaw
    from ebac.scenario import Scenario


@cache
def tuned_laws() -> tuple[str, ...]:
    """Return the names of the laws with tuned parameters: "tca-damped-tuned", "tca-damped-tuned-observer" and so on."""
    return tuple(dict.fromkeys(f"{row['law']}{end}" for end in _TUNED for row in _tuned_rows(end)))


def tuned(name: str, delay: int) -> tuple[str, dict[str, Any]]:
    """Return the law behind a name of `tuned_laws`, and its parameters for the nearest delay [samples].

    They were searched for the reference device at 1 kHz with `ebac tune all --device-noise 0.03 --evaluations 480
    --json`, and with `--observer-every-law`; other devices need a search of their own.
    """
    law, end, more = name.partition("-tuned")
    rows = [row for row in _tuned_rows(end + more) if row["law"] == law]
    nearest = min(rows, key=lambda row: abs(row["delay"] - delay))
    return law, dict(nearest["changes"])


def tuned_text(name: str) -> str:
    """Return what a law of `tuned_laws` is, in a sentence without its full stop."""
    law, _, end = name.partition("-tuned")
    text = f"{name} is {law} with the parameters that `ebac tune` found for the reference device at 1 kHz"
    return text + (", acting on the observer's estimate" if end else "")


def on_its_observer(scenario: Scenario, law: AnyLaw) -> Scenario:
    """Return a scenario in which a law acts on the observer's estimate, if its parameters were tuned so.

    Parameters
    ----------
    scenario : Scenario
        Comes back as it is under any other law.
    law : law
        As `simulate` takes it.

    Raises
    ------
    ValueError
        For a law "...-observer" where the scenario turns the observer off, or the device has no force sensor.
    """
    name = getattr(law, "law", law)  # of a Variant, too
    if not isinstance(name, str) or name not in tuned_laws() or not name.endswith("-observer"):
        return scenario
    instead = f"{name.partition('-tuned')[0]}-tuned"
    if not scenario.device.sensor.fitted:
        raise ValueError(
            f"{name}: acts on the estimate of the state observer, which needs a force sensor, and the device has none; "
            f"use {instead}"
        )
    if not scenario.observer:
        raise ValueError(
            f"{name}: acts on the estimate of the state observer, which is off; turn it on with observer=True, or use "
            f"{instead}"
        )
    if scenario.observer in (True, "every-law"):
        return scenario.replace(observer="every-law")
    own = scenario.designed_observer()
    return scenario.replace(observer=own and own.replace(every_law=True))


#: What the searches found, by the ending of the laws' names.
_TUNED = {"-tuned": "tuned_rivals.json", "-tuned-observer": "tuned_rivals_observer.json"}


@cache
def _tuned_rows(ending: str) -> list[dict[str, Any]]:
    text = Path(__file__).with_name(_TUNED[ending]).read_text(encoding="utf-8")
    rows: list[dict[str, Any]] = json.loads(text)["rows"]
    return rows
