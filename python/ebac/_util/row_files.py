"""Rows of a result as text for other programs: one JSON document, or CSV."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from ebac._util.atomic_file import draft, write_text


def document(command: str, rows: Sequence[Mapping[str, Any]], **more: Any) -> str:
    """Return the JSON of a command: its name, the version, `more` and the list `rows`.

    A number that is not finite becomes null.
    """
    from ebac import __version__

    values = {"command": command, "version": __version__, **more, "rows": rows}
    return json.dumps(_finite(values), indent=2, allow_nan=False)


def _finite(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(name): _finite(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not isfinite(value) else value


def save(path: str | Path, document: str, rows: Sequence[Mapping[str, Any]]) -> None:
    """Write a document to a .json file, or rows to a .csv file; ValueError for another extension."""
    from ebac.logs.files import extension

    file = Path(path)
    if extension(file, (".json", ".csv")) == ".csv":
        csv_table(file, rows)
    else:
        write_text(file, document + "\n")


def csv_table(path: Path, rows: Sequence[Mapping[str, Any]], headings: Sequence[str] = ()) -> None:
    """Write rows of the same names as CSV; `headings` are the names, needed where there may be no row."""
    with draft(path) as name, name.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(headings or rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
