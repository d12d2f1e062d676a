"""What `--json` prints against the reference page: every key of a command stands on it."""

import json
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "json.md"
#: Objects whose keys are those of a file or an option, or names of files, topics, surfaces and parameters.
NAMED = {
    "bands_Hz", "changes", "compensation", "limits", "messages", "remarks", "residuals", "scenario", "surfaces_m",
    "truth", "values",
}  # fmt: skip


@cache
def documented() -> frozenset[str]:
    return frozenset(re.findall(r"`(\w+)`", PAGE.read_text("utf-8")))


def undocumented(printed: Any) -> set[str]:
    """Return the keys of a document that the page does not have."""
    if isinstance(printed, list):
        return set().union(*map(undocumented, printed))
    if not isinstance(printed, dict):
        return set()
    below = (undocumented(value) for key, value in printed.items() if key not in NAMED)
    return (set(printed) - documented()).union(*below)


def looked_at(document: Callable[..., str], missing: set[str]) -> Callable[..., str]:
    """Return the function that makes documents; the keys that the page lacks are added to `missing`."""

    def made(command: str, *rows: Any, **more: Any) -> str:
        text = document(command, *rows, **more)
        missing.update(f"ebac {command}: {key}" for key in undocumented(json.loads(text)))
        return text

    return made
