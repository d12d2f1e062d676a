"""Sentences about a wrong call, from the signature of what was called."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import index
from typing import Any

from ebac._util.arguments import refuse_unknown, shown


@dataclass(frozen=True)
class _Parameter:
    name: str
    annotation: str = "Any"
    needed: bool = True
    by_name_only: bool = False


def core_sentence(
    label: str, name: str, message: str, values: tuple[Any, ...], given: dict[str, Any]
) -> str:
    """Return what is wrong with a call of the core, from pybind11's own message.

    Parameters
    ----------
    label, name : str
        What was called, as people write it ("Encoder.read"), and its bare name.
    message : str
        pybind11's message: it lists the signatures.
    values, given
        Arguments of the call, the object itself among them.
    """
    listed = re.findall(r"^    \d+\. [^(]*\((.*)\)(?: -> .*)?$", message, re.MULTILINE)
    overloads = [list(_parsed(text)) for text in listed]
    is_method = name == "__init__" or any(o and o[0].name in {"self", "arg0"} for o in overloads)
    if is_method and values:
        owner, values = values[0], values[1:]
        if name != "__init__" and type(owner).__name__ != label.split(".")[0]:
            own = overloads[0][0].annotation.rpartition(".")[2]
            if not own.startswith("_") and own != "object":
                return f"{label} is a method of {own}, not of {shown(owner)}"
    takes = [[p for p in o if p.name not in {"self", "arg0"}] for o in overloads]
    if takes and takes[0] and takes[0][0].name == "arg1":  # the setter of a property
        return f"{label} = {values[0]!r}: must be {_words(takes[0][0].annotation)}"
    sentences = [_sentence(label, parameters, values, given) for parameters in takes]
    return min(sentences, key=len) if sentences else f"{label} cannot be called like this"


def python_sentence(
    called: Callable[..., Any], values: tuple[Any, ...], given: dict[str, Any]
) -> str:
    """Return what is wrong with the call of a class or of a public function written in Python."""
    kinds = inspect.Parameter
    label = called.__name__ if isinstance(called, type) else _public_name(called)
    parameters = list(inspect.signature(called).parameters.values())
    if parameters and parameters[0].name in ("self", "cls") and not isinstance(called, type):
        label, parameters, values = called.__qualname__, parameters[1:], values[1:]
    if given and parameters[0].kind is kinds.VAR_POSITIONAL:
        return f"{label} takes its {parameters[0].name} in order, not by name: {next(iter(given))}"
    takes = [
        _Parameter(p.name, "Any", p.default is kinds.empty, p.kind is kinds.KEYWORD_ONLY)
        for p in parameters
    ]
    return _sentence(label, takes, values, given)


def _public_name(function: Callable[..., Any]) -> str:
    """Return how people write a public function: ebac.study, ebac.identify.load, ebac.identify.excitation.chirp."""
    import ebac

    name = function.__name__
    public = name in dir(ebac) and inspect.unwrap(getattr(ebac, name)) is inspect.unwrap(function)
    room = "ebac" if public else ".".join(function.__module__.split(".")[:2])
    if not hasattr(sys.modules[room], name):
        room = function.__module__
    return f"{room}.{name}"


def refuse_names(label: str, call: Callable[..., Any], given: Mapping[str, Any]) -> None:
    """Raise TypeError for a name that a call does not take, or for one that it needs and that is not given."""
    takes = inspect.signature(call).parameters.values()
    if any(p.kind is p.VAR_KEYWORD for p in takes):
        return
    names = [p.name for p in takes]
    refuse_unknown(label, given, names)
    if missing := [p.name for p in takes if p.default is p.empty and p.name not in given]:
        raise TypeError(f"{label} needs {', '.join(missing)}; it has: {', '.join(names)}")


def _parsed(text: str) -> Iterator[_Parameter]:
    """Read "self: ebac._core.Wall, x: float = 1.0" of a docstring."""
    by_name = False
    for part in _split(text):
        if part.startswith("*"):
            by_name = True
            if part.startswith("**"):
                yield _Parameter("**", needed=False)
            continue
        head, has_default, _ = part.partition(" = ")
        name, _, annotation = head.partition(": ")
        yield _Parameter(name, annotation or "Any", not has_default, by_name)


def _split(text: str) -> Iterator[str]:
    """Cut at the outermost commas."""
    depth, start = 0, 0
    for i, c in enumerate(text):
        depth += (c in "([{") - (c in ")]}")
        if c == "," and depth == 0:
            yield text[start:i].strip()
            start = i + 1
    if text[start:].strip():
        yield text[start:].strip()


def _sentence(
    label: str, takes: Sequence[_Parameter], values: tuple[Any, ...], given: dict[str, Any]
) -> str:
    names = [p.name for p in takes if p.name != "**"]
    has = f"; it has: {', '.join(names)}" if names else ""
    if not takes and (values or given):
        return f"{label} takes no parameters, not {shown([*values, *given.values()][0])}"
    if len(names) == len(takes):
        try:
            refuse_unknown(label, given, names)
        except TypeError as error:
            return str(error)
    in_order = [p for p in takes if not p.by_name_only and p.name != "**"]
    if values and not in_order:
        return f"{label} takes its parameters by name, not {shown(values[0])}{has}"
    if len(values) > len(in_order):
        many = "1 value" if len(in_order) == 1 else f"{len(in_order)} values"
        return f"{label} takes {many} in order, not {len(values)}{has}"
    bound = dict(zip([p.name for p in in_order], values, strict=False))
    if twice := [name for name in given if name in bound]:
        return f"{label}: {twice[0]} is given twice, as {bound[twice[0]]!r} and by name"
    bound |= given
    if missing := [p.name for p in takes if p.needed and p.name not in bound]:
        return f"{label} needs {', '.join(missing)}{has}"
    for p in takes:
        if p.name in bound and not _accepts(p.annotation, bound[p.name]):
            return f"{label}: {p.name} = {_short(bound[p.name])}: must be {_words(p.annotation)}"
    for name, value in bound.items():
        if isinstance(value, int) and not 0 <= value < 2**31:
            return f"{label}: {name} = {value}: does not fit into the integer it is kept in"
    must = "; ".join(f"{p.name} must be {_words(p.annotation)}" for p in takes if p.name in bound)
    if must:
        return f"{label} was called with wrong values: {must}"
    name = next((name for name, value in bound.items() if value is None), next(iter(bound), ""))
    if not name:
        return f"{label} cannot be called like this"
    return f"{label}.{name} = {_short(bound[name])}: is of the wrong kind; leave it out for the default"


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"a {type(value).__name__}"


def _words(annotation: str) -> str:
    """Return a type as people name it."""
    size = re.search(r"FixedSize\((\d+)\)", annotation)
    if "ArrayLike" in annotation or "Sequence[typing.Supports" in annotation:
        what = "integers" if "SupportsInt" in annotation else "numbers"
        return f"a list of {size[1] if size else ''} {what}".replace("  ", " ")
    kinds = [_word(part) for part in annotation.split(" | ") if part != "typing.SupportsIndex"]
    kinds[1:] = [re.sub("^an? (?=[A-Z])", "", kind) for kind in kinds[1:]]  # a Wall, Disc or Free
    return " or ".join(filter(None, [", ".join(kinds[:-1]), kinds[-1]]))


def _word(part: str) -> str:
    plain = {
        "typing.SupportsFloat": "a number",
        "typing.SupportsInt": "an integer",
        "bool": "True or False",
        "str": "a string",
    }
    if part in plain or not part.startswith("ebac._core."):
        bare = re.sub(r"[\w.]*\.(\w+)", r"\1", part)
        return plain.get(part, re.sub(r"Sequence\[(\w+)\]", r"a list of \1", bare))
    name = part.rpartition(".")[2]
    return f"{'an' if name[0] in 'AEIO' else 'a'} {name}"


def _accepts(annotation: str, value: Any) -> bool:
    """Return whether a value may be what a parameter takes; True where that cannot be judged."""
    if "ArrayLike" in annotation or "Sequence[typing.Supports" in annotation:
        return _is_list(annotation, value)
    checks: dict[str, Callable[[Any], object]] = {
        "typing.SupportsFloat": lambda v: isinstance(v, str) or float(v),
        "typing.SupportsInt": index,
        "typing.SupportsIndex": index,
    }
    for part in annotation.split(" | "):
        if part in checks:
            try:
                checks[part](value)
            except (TypeError, ValueError):
                continue
            if not isinstance(value, str):
                return True
        elif part in {"bool", "str", "bytes", "None"}:
            if type(value).__name__.removesuffix("Type") == part:
                return True
        elif "Sequence[" in part:
            if hasattr(value, "__iter__") and not isinstance(value, str):
                return True
        elif not re.fullmatch(r"ebac\._core\.\w+", part) or any(
            base.__name__ == part.rpartition(".")[2] for base in type(value).__mro__
        ):
            return True
    return False


def _is_list(annotation: str, value: Any) -> bool:
    import numpy as np

    size = re.search(r"FixedSize\((\d+)\)", annotation)
    try:
        array = np.asarray(value)
    except ValueError:  # rows of several lengths
        return False
    right = array.dtype.kind in ("iu" if "SupportsInt" in annotation else "iufb")
    return (
        right
        and (array.ndim > 0 or "ArrayLike" in annotation)
        and (size is None or len(array) == int(size[1]))
    )
