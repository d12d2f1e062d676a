"""Text files, or a sentence that names the line that is none."""

from __future__ import annotations

from collections import Counter
from itertools import chain
from os import SEEK_END
from pathlib import Path
from typing import TypeVar

from ebac._util.at_user import warn

Line = TypeVar("Line", str, list[str])  # as text, or in cells

#: How the first line of a sample CSV begins, see `ebac demo`.
SIMULATED = "Simulated by ebac"


#: So much of the end of a file is read for its last line [bytes].
LONGEST = 10_000


def says_simulated(path: str | Path) -> bool:
    """Return whether the first lines of a file say that it is simulated: the note of a sample, or a column `true.x`."""
    with Path(path).open("rb") as file:
        head = file.readline() + file.readline()
    return head.startswith(f"# {SIMULATED}".encode()) or b"true.x" in head


def check_end(path: str | Path) -> None:
    """Refuse a CSV file of ours whose last line has no end; warn of one of another program, where that is usual.

    It may have been cut inside its last number, which then is another one.

    Raises
    ------
    ValueError
        For one that `Trace.to_csv` or `ebac demo` wrote; the message does not name the file.
    """
    with Path(path).open("rb") as file:
        ours = file.readline().startswith(b"tick,t [s],") or says_simulated(path)
        file.seek(max(0, file.seek(0, SEEK_END) - LONGEST))
        last = file.read().splitlines(keepends=True)[-1:]
    if not last or last[0].endswith((b"\n", b"\r")) or last[0].startswith((b"#", b"%")):
        return
    found = (
        f"its last line has no end, so it may be cut: ...{last[0][-20:].decode(errors='replace')}"
    )
    if ours:
        raise ValueError(f"{found}; delete the last line, or end it if it is whole")
    warn(f"{path}: {found}; check its last number, and end that line if it is whole")


def read_text(path: str | Path) -> str:
    """Return the text of a file in UTF-8, a byte order mark aside.

    Raises
    ------
    OSError
        When it cannot be opened.
    ValueError
        When it is no text; the message names the line, not the file.
    """
    data = Path(path).read_bytes()
    try:
        text, wrong = data.decode("utf-8-sig"), data.find(b"\0")
    except UnicodeDecodeError as error:
        text, wrong = "", error.start
    if wrong < 0:
        return text.replace("\r\n", "\n")
    line = data.count(b"\n", 0, wrong) + 1
    raise ValueError(
        f"is no text in UTF-8 (line {line}, byte 0x{data[wrong]:02x}); save it in UTF-8, or check that it is the "
        "right file"
    )


def with_rows(lines: list[Line]) -> list[Line]:
    """Return the lines of a CSV file, if they are a heading and rows.

    Raises
    ------
    ValueError
        For fewer than two.
    """
    if len(lines) < 2:
        what = (
            "has no rows below its heading"
            if lines
            else "is empty: needs a heading and rows below it"
        )
        raise ValueError(f"the file {what}")
    return lines


def delimited(lines: list[str]) -> tuple[str, list[str]]:
    """Return the mark between the columns of a CSV file, and its lines, the heading first.

    Where the mark is no comma, a comma below the heading is a decimal one and becomes a point.

    Raises
    ------
    ValueError
        When there are spaces between the columns, or it is no table at all.
    """
    mark = max(",;\t", key=lines[0].count)
    if mark not in lines[0] and len(lines) > 1 and len(lines[1].split()) > 1:
        if not _is_table([line.split() for line in lines[1:]]):
            raise ValueError(
                "is no table of numbers; it needs a heading and rows of as many numbers, with commas between them"
            )
        raise ValueError(
            "its columns have spaces between them; put commas, semicolons or tabs there"
        )
    if mark != ",":
        lines = [lines[0], *(line.replace(",", ".") for line in lines[1:])]
    return mark, lines


def _is_table(rows: list[list[str]]) -> bool:
    """Return whether most rows have equally many words, and any word begins as a number does."""
    (_, usual), *_ = Counter(map(len, rows)).most_common(1)
    numbers = any(word.lstrip("+-.,")[:1].isdigit() for word in chain.from_iterable(rows))
    return 2 * usual > len(rows) and numbers
