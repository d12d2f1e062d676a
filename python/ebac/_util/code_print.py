"""What the code of a Python object does, as text that changes when the code does."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from types import CodeType, FunctionType
from typing import Any

#: Where an object lies in memory, in a text that has nothing better: another place in every run.
ADDRESS = re.compile(r" at 0x[0-9a-fA-F]+")
#: What a class holds beside its code; `copy` adds the slot names when an object is first copied.
_NO_CODE = ("__module__", "__doc__", "__firstlineno__", "__slotnames__")
_PLAIN = (bool, int, float, complex, str, bytes, type(None))


def code_print(kind: type | FunctionType) -> str:
    """Return the instructions of a class or function, and of what they name in its module.

    That is functions, classes and plain constants. Of other modules, and of arrays or tables that the code names,
    nothing is taken.
    """
    return "\n".join(_of(kind, kind.__module__, set()))


def _of(thing: Any, module: str, seen: set[int]) -> Iterator[str]:
    if isinstance(thing, (staticmethod, classmethod)):
        thing = thing.__func__
    parts = thing.fget if isinstance(thing, property) else thing
    if isinstance(parts, _PLAIN):
        yield repr(parts)
    elif isinstance(parts, (list, tuple)):
        for part in parts:
            yield from _of(part, module, seen)
    elif getattr(parts, "__module__", None) == module and id(parts) not in seen:
        seen.add(id(parts))
        if isinstance(parts, FunctionType):
            yield from _of_function(parts, module, seen)
        elif isinstance(parts, type):
            yield from _of_class(parts, module, seen)


def _of_class(kind: type, module: str, seen: set[int]) -> Iterator[str]:
    for base in kind.__bases__:
        yield from _of(base, module, seen)
    for name, value in vars(kind).items():
        if name not in _NO_CODE:
            yield name
            yield from _of(value, module, seen)


def _of_function(function: FunctionType, module: str, seen: set[int]) -> Iterator[str]:
    yield from map(repr, (function.__defaults__, function.__kwdefaults__))
    for code in _codes(function.__code__):
        yield code.co_code.hex()
        yield repr([_plain(value) for value in code.co_consts if not isinstance(value, CodeType)])
        for name in code.co_names:
            yield name
            yield from _of(function.__globals__.get(name), module, seen)
    for cell in function.__closure__ or ():
        with suppress(ValueError):  # a cell that is empty
            yield from _of(cell.cell_contents, module, seen)


def _plain(value: Any) -> Any:
    """Return a constant whose text is the same in every process: that of a set is not."""
    return sorted(map(repr, value)) if isinstance(value, frozenset) else value


def _codes(code: CodeType) -> Iterator[CodeType]:
    """Return a code object and those of the functions within it."""
    yield code
    for value in code.co_consts:
        if isinstance(value, CodeType):
            yield from _codes(value)
