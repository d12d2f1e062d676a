"""The docstring of every public function has a section that names each of its parameters."""

import inspect
import re
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

import ebac


def functions(module: ModuleType = ebac, path: str = "ebac") -> Iterator[tuple[str, Any]]:
    """Give the functions in Python of the package, the folders in it and theirs, with the names they are called by."""
    for name in getattr(module, "__all__", dir(module)):
        thing = getattr(module, name)
        if inspect.ismodule(thing) and (path == "ebac" or hasattr(thing, "__all__")):
            yield from functions(thing, f"{path}.{name}")
        elif inspect.isfunction(thing) and re.match(r"ebac\.(?!_core)", thing.__module__):
            yield f"{path}.{name}", thing


def described(function: Callable[..., Any]) -> set[str]:
    """Return the parameters that the section of a docstring names."""
    text = inspect.getdoc(function) or ""
    section = re.search(r"^Parameters\n-+\n(.*?)(?=^\w[\w ]*\n-+\n|\Z)", text, re.M | re.S)
    heads = re.findall(r"^(\S.*?)(?: :.*)?$", section[1], re.M) if section else []
    return {name.strip().lstrip("*") for head in heads for name in head.split(",")}


def test_every_public_function_names_its_parameters() -> None:
    lacking = {
        f"{name}: {', '.join(sorted(missing))}"
        for name, function in functions()
        if (missing := {*inspect.signature(function).parameters} - described(function))
    }
    assert not lacking, "\n".join(sorted(lacking))
