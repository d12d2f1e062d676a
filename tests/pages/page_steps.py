"""What a page or a help text asks its reader to do, step by step: shell commands and Python."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer.main

from ebac.cli import app

ROOT = Path(__file__).parents[2]
_FENCE = re.compile(
    r"^(?P<indent> *)```(?P<kind>sh|python) *\n(?P<text>.*?)^(?P=indent)```", re.M | re.S
)


@dataclass(frozen=True, kw_only=True)
class Step:
    """One shell command, or one block of Python, and the folder in which it is done."""

    kind: str  # "sh" or "python"
    text: str
    line: int = 1
    room: str = "."

    @property
    def tests(self) -> bool:
        """Whether pytest would find tests in it."""
        if self.kind != "python":
            return False
        names = [node.name for node in ast.parse(self.text).body if hasattr(node, "name")]
        return any(name.startswith(("test_", "Test")) for name in names)


def pages() -> list[Path]:
    """Return README and every page of the documentation."""
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def notebooks() -> list[Path]:
    """Return the pages that are notebooks."""
    return [page for page in pages() if "```{code-cell}" in page.read_text(encoding="utf-8")]


def steps(page: Path) -> list[Step]:
    """Return the fenced `sh` and `python` blocks of a page in their order, each shell command for itself."""
    text = page.read_text(encoding="utf-8")
    return [step for match in _FENCE.finditer(text) for step in _of_block(match, text)]


def _of_block(match: re.Match[str], text: str) -> Iterator[Step]:
    first = text[: match.start("text")].count("\n") + 1
    lines = [line.removeprefix(match["indent"]) for line in match["text"].splitlines()]
    if match["kind"] == "python":
        yield Step(kind="python", text="\n".join([*lines, ""]), line=first)
        return
    begun = ""
    for number, line in enumerate(lines, first):
        begun += line.rstrip().removesuffix("\\")
        if line.rstrip().endswith("\\"):
            continue
        command = re.sub(r"(^|\s+)#.*", "", begun).strip()
        if command:
            yield Step(kind="sh", text=command, line=number)
        begun = ""


def inline(page: Path) -> list[str]:
    """Return the commands of ebac in sentences and tables that are written out: no capitals, no dots for more."""
    text = re.sub(r"^ *```.*?^ *```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    spans = re.findall(r"`(ebac [a-z][^`]*)`", text)
    return sorted({span for span in spans if not re.search(r"[A-Z]{3}|\.\.\.|,", span)})


def commands() -> dict[str, Any]:
    """Return every command of ebac by its full name, groups left out."""
    return dict(_below("ebac", typer.main.get_command(app)))


def _below(name: str, command: Any) -> Iterator[tuple[str, Any]]:
    if not hasattr(command, "commands"):
        yield name, command
    for part, child in getattr(command, "commands", {}).items():
        if not child.hidden:
            yield from _below(f"{name} {part}", child)


def examples(name: str, command: Any) -> list[Step]:
    """Return the examples of a help text: in its list, what stands between backticks and begins as a command."""
    paragraphs = (" ".join(text.split()) for text in (command.help or "").split("\n\n"))
    spans = [
        span
        for text in paragraphs
        if text.startswith(("* ", "**Example**"))
        for span in re.findall(r"`([^`]+)`", text)
    ]
    wanted = (span for span in spans if re.match(r"(sudo|ebac) [a-z]", span))
    return [Step(kind="sh", text=span, room=name.replace(" ", "-")) for span in wanted]
