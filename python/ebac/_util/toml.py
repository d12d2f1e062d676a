"""TOML text, and one kind of error for all that is none."""

from __future__ import annotations

import re
import tomllib
from typing import Any

#: A line such as `seconds = 10 s`; not a number in another base, as 0x1F.
_NUMBER_AND_UNIT = re.compile(
    r"\s*[\w.-]+\s*=\s*[-+]?\d+(\.\d+)?([eE][-+]?\d+)?(\s+|(?![eExob_]))"
    r"(?P<unit>[A-Za-zµμΩ°%][\w ./*^()²³·%°-]*?)\s*(#.*)?$"
)


def parsed(text: str) -> dict[str, Any]:
    """Return the table of a document.

    Raises
    ------
    ValueError
        When it is none; also for what the standard library's parser gives up on with another exception.
    """
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ValueError("lists or tables within one another too deeply") from None
    except tomllib.TOMLDecodeError as error:
        again = re.match(r"Cannot overwrite a value \(at line (\d+), column \d+\)", str(error))
        if again is not None:
            raise ValueError(_key_again(text, int(again[1]))) from None
        twice = re.match(r"Cannot declare \((.*)\) twice(.*)", str(error))
        if twice is None:
            hint = _comma(text, str(error)) or _with_unit(text, str(error))
            if not hint and str(error).startswith("Invalid value"):
                hint = "; write true or false, a number without its unit, or text in quotes"
            raise ValueError(f"{error}{hint}") from None
        table = ".".join(re.findall("'([^']*)'", twice[1]))
        raise ValueError(f"the table [{table}] is there twice{twice[2]}; merge the two") from None


def _key_again(text: str, line: int) -> str:
    """Return what is wrong with a key that is on this line, from 1, and in the same table before."""
    lines = text.split("\n")[:line]
    key = lines[-1].partition("=")[0].strip()
    headings = [found[1] for one in lines if (found := re.match(r"\s*\[+([^\]]+)\]", one))]
    name = f"{headings[-1].strip()}.{key}" if headings else key
    return f"{name} is given a second time on line {line}; keep one of the two"


def _comma(text: str, message: str) -> str:
    """Return a hint where the line of an error has a decimal comma; "" where it has none."""
    found = re.search(r"=\s*([-+]?\d+),(\d+)", _line(text, message))
    return f"; give numbers a decimal point: {found[1]}.{found[2]}" if found else ""


def _with_unit(text: str, message: str) -> str:
    """Return a hint where the line of an error is a name, a number and a unit; "" where it is not."""
    found = _NUMBER_AND_UNIT.match(_line(text, message))
    return (
        f"; a number has no unit in TOML: leave out {found['unit']}, and give it in SI units"
        if found
        else ""
    )


def _line(text: str, message: str) -> str:
    """Return the line that a message of the parser names; "" where it names none."""
    found = re.search(r"\(at line (\d+)", message)
    return text.split("\n")[int(found[1]) - 1] if found else ""
