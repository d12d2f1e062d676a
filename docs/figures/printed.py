"""What the commands print, as JSON, and the places in the pages where their tables stand.

A table stands between `<!-- table: NAME -->` and `<!-- end -->`; what lies between is written anew, nothing else.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import ebac
from ebac.studies.condition import Condition

MARKED = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end -->)", re.S)
Row = dict[str, Any]
#: Every study of these pages has it: the force sensor's noise [N], which the observer is designed for.
NOISE = "--device-noise 0.03"
#: What that makes of the reference scenario.
NOISY = ebac.Scenario(device=ebac.Device(sensor=ebac.ForceSensor(noise=0.03)))
#: Energy that is written as 0 [J].
NOTHING = 5e-8


@dataclass(frozen=True, kw_only=True)
class Printed:
    """Runs `ebac ... --json`, each command once.

    Attributes
    ----------
    folder : Path
        Where the documents are kept. What lies there already is not run again.
    threads : int or None
        For the commands that take a number of threads; None: one per core.
    """

    folder: Path
    threads: int | None = None

    def document(self, command: str) -> dict[str, Any]:
        """Return the document of a command, without the word `ebac`."""
        file = self.folder / (re.sub(r"[^\w.=,+]+", "-", command) + ".json")
        if not file.exists():
            print(f"ebac {command}", flush=True)
            single = command.split()[0] in ("bench", "engines", "identify", "shapes", "wall")
            single |= command.startswith("gastroscopy") and "study" not in command
            many = self.threads is not None and not single
            words = [
                *command.split(),
                "--json",
                *(["--threads", str(self.threads)] if many else []),
            ]
            made = subprocess.run(
                [sys.executable, "-m", "ebac.cli", *words], stdout=subprocess.PIPE, check=True
            )
            file.write_bytes(made.stdout)
        found: dict[str, Any] = json.loads(file.read_bytes())
        return found

    def rows(self, command: str) -> list[Row]:
        """Return the records of a command."""
        rows: list[Row] = self.document(command)["rows"]
        return rows

    def kept(self, name: str, find: Callable[[], list[Row]]) -> list[Row]:
        """Return what was found in Python, from the folder where it lies there already."""
        file = self.folder / f"{name}.json"
        if not file.exists():
            print(name, flush=True)
            file.write_text(json.dumps(find()), encoding="utf-8")
        rows: list[Row] = json.loads(file.read_bytes())
        return rows

    def studied(
        self,
        name: str,
        conditions: Sequence[str | Condition],
        base: ebac.Scenario,
        seed: int = 1,
    ) -> list[Row]:
        """Return a row for each condition, of `ebac` and the 60 hands."""

        def found() -> list[Row]:
            hands = ebac.Operators.grid()
            study = ebac.study(
                hands, ["ebac"], conditions, base=base, seed=seed, threads=self.threads
            )
            return [row.row() for row in study.rows]

        return self.kept(name, found)


def names(page: Path) -> list[str]:
    """Return the names of the tables that have a place in a page."""
    return [place[2] for place in MARKED.finditer(page.read_text(encoding="utf-8"))]


def put(page: Path, name: str, text: str) -> bool:
    """Write a table into its place; return whether it has changed."""
    before = page.read_text(encoding="utf-8")

    def renew(place: re.Match[str]) -> str:
        return f"{place[1]}{text.strip()}\n{place[3]}" if place[2] == name else place[0]

    after = MARKED.sub(renew, before)
    page.write_text(after, encoding="utf-8")
    return after != before


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table."""
    first, *rest = (f"| {' | '.join(line)} |" for line in (heads, *rows))
    return "\n".join([first, f"|{'---|' * len(heads)}", *rest])


def code(name: str) -> str:
    """Return a name as it is typed."""
    return f"`{name}`"


def joules(energy: float | None, unit: str = "") -> str:
    """Return an energy [J] in mJ, with `unit` behind it, or from 1 J on in J, which is written; 0 below `NOTHING`.

    No line breaks between number and unit.
    """
    if energy is None:
        return "-"
    if abs(energy) < NOTHING:
        return "0"
    if abs(energy) < 0.9995:
        told = f"{1e3 * energy:.3g}{unit}"
    else:
        told = f"{energy:.0f} J" if abs(energy) >= 99.95 else f"{energy:.1f} J"
    return told.replace(" ", "\u00a0")


def millijoules(energy: float | None) -> str:
    """Return an energy [J] in mJ; from 1 J on rounded to 0.1 J, from 100 J on to 1 J; 0 below `NOTHING`."""
    if energy is None:
        return "-"
    if abs(energy) < NOTHING:
        return "0"
    if abs(energy) < 0.9995:
        return f"{1e3 * energy:.3g}"
    return f"{round(1e3 * energy, -3 if abs(energy) >= 99.95 else -2):,.0f}"


def of_two(*counts: object) -> str:
    """Return counts, once where they are the same; no line breaks between them."""
    return "\u00a0/\u00a0".join(dict.fromkeys(str(n) for n in counts))


def fixed(number: float | None, digits: int, scale: float = 1.0) -> str:
    """Return a number with so many digits behind the point."""
    return "-" if number is None else f"{scale * number:.{digits}f}"
