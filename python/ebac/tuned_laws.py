"""Laws whose parameters `ebac tune` found, by names such as "tca-damped-tuned"."""

from __future__ import annotations

import json
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

from ebac._util.remarks import remark


@cache
def tuned_laws() -> tuple[str, ...]:
    """Return the names of the laws with tuned parameters: "tca-damped-tuned", "tca-damped-tuned-observer" and so on."""
    return tuple(dict.fromkeys(f"{row['law']}{end}" for end in _TUNED for row in _tuned_rows(end)))


def tuned(name: str, delay: int) -> tuple[str, dict[str, Any]]:
    """Return the law behind a name of `tuned_laws`, and its parameters for the nearest delay [samples].

    They were searched for the reference device at 1 kHz with `ebac tune all --device-noise 0.03 --json`, and with
    `--observer-every-law`; other devices need a search of their own.
    """
    law, end, more = name.partition("-tuned")
    rows = [row for row in _tuned_rows(end + more) if row["law"] == law]
    nearest = min(rows, key=lambda row: abs(row["delay"] - delay))
    return law, dict(nearest["changes"])


def tuned_text(name: str) -> str:
    """Return what a law of `tuned_laws` is, in a sentence without its full stop."""
    law, _, end = name.partition("-tuned")
    text = f"{name} is {law} with the parameters that `ebac tune` found for the reference device at 1 kHz"
    how = ', acting on the observer\'s estimate: use it with Scenario(observer="every-law")'
    return text + (how if end else "")


def warn_without_observer(laws: Iterable[Any], observers: Iterable[Any]) -> None:
    """Warn of laws that were tuned for the observer where not every law acts on it.

    Parameters
    ----------
    laws : iterable of laws
        As `simulate` takes them.
    observers : iterable of bool, "every-law" or Observer
        Of the scenarios that they are to run.
    """
    names = (getattr(law, "law", law) for law in laws)  # of a Variant, too
    known = {n for n in names if isinstance(n, str) and n.endswith(_OBSERVED) and n in tuned_laws()}
    if known and not all(_for_every_law(one) for one in observers):
        remark("; ".join(tuned_text(name) for name in sorted(known)))


def _for_every_law(observer: Any) -> bool:
    """Return whether every law acts on an observer of a scenario."""
    if isinstance(observer, (bool, str)):
        return observer == "every-law"
    return bool(observer.every_law)


#: How the names of laws end that were tuned for the observer.
_OBSERVED = "-tuned-observer"
#: What `ebac tune` found, by the ending of the laws' names.
_TUNED = {"-tuned": "tuned_rivals.json", _OBSERVED: "tuned_rivals_observer.json"}


@cache
def _tuned_rows(ending: str) -> list[dict[str, Any]]:
    text = Path(__file__).with_name(_TUNED[ending]).read_text(encoding="utf-8")
    rows: list[dict[str, Any]] = json.loads(text)["rows"]
    return rows
