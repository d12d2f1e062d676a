"""What the docstring of a class says of each of its parameters."""

from __future__ import annotations

import inspect
import re

_ENTRY = re.compile(r"^(\w+(?:, \w+)*) : ")
_SECTION = re.compile(r"^(Parameters|Attributes)\n-+\n(.*?)(?=^\w[\w ]*\n-{3,}\n|\Z)", re.M | re.S)


def parameters(cls: type) -> dict[str, str]:
    """Return the meaning of each parameter or attribute in a NumPy docstring, in one line; that of a pair twice."""
    found: dict[str, str] = {}
    for _, section in _SECTION.findall(inspect.getdoc(cls) or ""):
        names: list[str] = []
        for line in section.splitlines():
            if entry := _ENTRY.match(line):
                names = entry[1].split(", ")
                found |= dict.fromkeys(names, "")
            elif line.startswith(" "):
                for name in names:
                    found[name] = f"{found[name]} {line.strip()}".strip()
    return found
