"""Messages for wrong calls: our own sentence in place of pybind11's or Python's."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum
from functools import wraps
from types import ModuleType
from typing import Any, ParamSpec, TypeVar

Class = TypeVar("Class", bound=type)
P = ParamSpec("P")
Result = TypeVar("Result")


def wrap_members(module: ModuleType) -> None:
    """Wrap the public functions of a compiled module and of its classes; the module calls it when it is loaded."""
    _wrap_members(module, module.__name__, "")


def _wrap_members(owner: Any, module: str, label: str) -> None:
    for name, value in list(vars(owner).items()):
        kind = type(value).__name__
        if isinstance(value, type):
            if value.__module__ == module and not issubclass(value, Enum):
                _wrap_members(value, module, f"{value.__qualname__}.")
        elif name.startswith("_") and name not in {"__init__", "__getitem__"}:
            continue
        elif kind == "wrapper_descriptor":  # pybind11's `__init__` of a class without constructor
            setattr(owner, name, _not_made)
        elif kind == "property" and value.fset:
            fset = wrapped(value.fset, f"{label}{name}", name)
            setattr(owner, name, property(value.fget, fset, value.fdel, value.__doc__))
        elif kind in {"instancemethod", "builtin_function_or_method"}:
            shown = label[:-1] if name == "__init__" else label + name
            setattr(owner, name, wrapped(value, shown, name))
        elif kind == "staticmethod":
            setattr(owner, name, staticmethod(wrapped(value.__func__, label + name, name)))


def wrapped(function: Any, label: str, name: str) -> Any:
    """Return a function that calls another one of pybind11, and says in our words what it refuses."""
    call = getattr(function, "__func__", function)

    def checked(*values: Any, **given: Any) -> Any:
        try:
            return call(*values, **given)
        except TypeError as error:
            text = str(error)
            if "(): incompatible " not in text[:80]:
                if (meant := _with_classes_shown(text, given.values())) == text:
                    raise
                raise TypeError(meant) from None
        from ebac._util.signatures import core_sentence

        raise TypeError(core_sentence(label, name, text, values, given))

    checked.__name__, checked.__doc__ = name, call.__doc__
    checked.__qualname__, checked.__module__ = label, "ebac._core"
    checked.__annotations__ = {}
    return checked


def _with_classes_shown(text: str, values: Iterable[Any]) -> str:
    """Return a message of the core that says of a class in place of an object what was meant."""
    from ebac._util.arguments import shown

    for value in values:
        if isinstance(value, type):
            text = text.replace(repr(value), shown(value))
    return text


def _not_made(self: Any, *values: Any, **given: Any) -> None:
    name = type(self).__name__
    raise TypeError(f"{name} has no constructor: functions of ebac return objects of it")


def plain_constructor(cls: Class) -> Class:
    """Decorate a class whose constructor refuses a wrong call with the names it takes."""
    construct: Callable[..., None] = getattr(cls, "__init__")  # noqa: B009
    setattr(cls, "__init__", _by_name(construct, lambda values: (type(values[0]), values[1:])))  # noqa: B010
    return cls


def plain_function(function: Callable[P, Result]) -> Callable[P, Result]:
    """Decorate a public function of `ebac` that refuses a wrong call with the names it takes."""
    return _by_name(function, lambda values: (function, values))


def _by_name(
    call: Callable[P, Result], split: Callable[[tuple[Any, ...]], tuple[Any, tuple[Any, ...]]]
) -> Callable[P, Result]:
    """Return the same call, refused by name; `split` returns what was called, and the values that it was given."""

    @wraps(call)
    def by_name(*values: P.args, **given: P.kwargs) -> Result:
        __tracebackhide__ = True  # a failed test shows the call, and what raises in it
        try:
            return call(*values, **given)
        except TypeError as error:
            inner = error.__traceback__ and error.__traceback__.tb_next
            if inner is not None:  # raised by a check of its own, not by the call
                raise
        from ebac._util.signatures import python_sentence

        called, own = split(values)
        raise TypeError(python_sentence(called, own, given))

    return by_name
