"""A table of a configuration written line by line: what it does not change stays as it is, comments too."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from ebac._util.atomic_file import write_text

#: Behind values that were found on simulated drives.
SIMULATED = "# of the simulated device: find it again on yours"
_ANY_TABLE = re.compile(r"^\s*\[")


def with_table(
    text: str,
    name: str,
    wanted: Mapping[str, Sequence[int]],
    note: str,
    *,
    simulated: bool = False,
) -> str:
    """Return the TOML text with these lists of whole numbers in the table `name`.

    Parameters
    ----------
    text : str
        The TOML text.
    name : str
        Of the table; where there is none it is added at the end.
    wanted : mapping of str to sequence of int
        The lists by key; other keys of the table stay.
    note : str
        Comment behind the heading of a table that is added.
    simulated : bool
        Whether the numbers are of the simulated device: then a comment behind each list says so, otherwise such a
        comment goes.

    Raises
    ------
    ValueError
        When the table stands there in a way that cannot be changed line by line.
    """
    heading = re.compile(rf"^\s*\[{re.escape(name)}\]\s*(#.*)?$")
    values = {key: list(numbers) for key, numbers in wanted.items()}
    mark = f" {SIMULATED}" if simulated else ""
    ending = "\r\n" if "\r\n" in text else "\n"
    if text and not text.endswith("\n"):
        text += ending
    lines = text.splitlines(keepends=True)
    start = next((i for i, line in enumerate(lines) if heading.match(line)), None)
    if start is None:
        block = "".join(f"{key} = {numbers}{mark}{ending}" for key, numbers in values.items())
        made = f"{text}{ending}[{name}] # {note}{ending}{block}"
    else:
        after = range(start + 1, len(lines))
        end = next((i for i in after if _ANY_TABLE.match(lines[i])), len(lines))
        made = "".join(
            [
                *lines[: start + 1],
                *_changed(lines[start + 1 : end], values, mark, ending),
                *lines[end:],
            ]
        )
    if not _holds(made, name, values):
        raise ValueError(f"{name} cannot be written line by line: set {values} by hand")
    return made


def rewrite(path: Path, change: Callable[[str], str]) -> None:
    """Change the text of a file, all or nothing; where the path is a link, that of the file it leads to.

    Raises what `change` does, and OSError.
    """
    write_text(path, change(path.read_bytes().decode("utf-8")))


def _holds(text: str, name: str, values: Mapping[str, list[int]]) -> bool:
    try:
        found = tomllib.loads(text).get(name)
    except tomllib.TOMLDecodeError:
        return False
    return isinstance(found, dict) and all(found.get(key) == one for key, one in values.items())


def _changed(
    lines: list[str], wanted: Mapping[str, list[int]], mark: str, ending: str
) -> list[str]:
    """Return the lines of the table with the wanted values and mark; other comments stay."""
    kept = list(lines)
    for name, numbers in wanted.items():
        key = re.compile(rf"^(\s*{name}\s*=\s*)\[[^\]]*\]")
        at = next((i for i, line in enumerate(kept) if key.match(line)), None)
        if at is None:
            kept.insert(0, f"{name} = {numbers}{mark}{ending}")
        else:
            line = key.sub(rf"\g<1>{numbers}", kept[at]).replace(SIMULATED, "").rstrip()
            kept[at] = f"{line}{mark}{ending}"
    return kept
