"""Laws whose parameters `ebac tune` found, by names such as "tca-damped-tuned"."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any


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


#: What `ebac tune` found, by the ending of the laws' names.
_TUNED = {"-tuned": "tuned_rivals.json", "-tuned-observer": "tuned_rivals_observer.json"}


@cache
def _tuned_rows(ending: str) -> list[dict[str, Any]]:
    text = Path(__file__).with_name(_TUNED[ending]).read_text(encoding="utf-8")
    rows: list[dict[str, Any]] = json.loads(text)["rows"]
    return rows
