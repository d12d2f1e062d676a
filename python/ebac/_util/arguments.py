"""Refuse wrong arguments with a sentence that names what is taken."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping, Sequence
from errno import EISDIR, ENOENT
from functools import wraps
from math import inf
from numbers import Integral, Real
from operator import index
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar

Class = TypeVar("Class", bound=type)
Value = TypeVar("Value")

#: What lists all names of a kind, where they are too many for a message.
LISTED_BY = {
    "law": "ebac laws",
    "hand": "ebac presets",
    "device": "ebac presets",
    "world": "ebac worlds",
    "condition": "ebac conditions",
    "data set": "ebac demo",
    "item of the paper": "ebac paper --help",
}
#: As many names stand in a message all the same.
FEW = 8

_MASS = "it is the sum of handle and rotor, give mechanics=ebac.Mechanics(handle_mass=...) without the rotor's share"
_RESOLUTION = (
    "give counts_per_turn, of the motor: 2 pi x drum_radius x radius / sector_radius / (one count at the handle in m); "
    "for 10 um on the reference device 2 pi x 0.005 x 0.1 / 0.1 / 10e-6 = 3142"
)
_DAMPING = (
    "its damping is another thing, a lower bound of the physical damping of the device, and too high a value lets the "
    "law give out energy that nobody has put in"
)
#: Laws whose damping is that of the device.
_BY_DAMPING = ("PassivityControl", "ISS", "ForceBounding", "EBA", "EBAAccount", "EBACPrinted")
#: Where a parameter is that people look for in another place.
ELSEWHERE = {
    **{(law, "virtual_damping"): f"it has no virtual damper; {_DAMPING}" for law in _BY_DAMPING},
    ("EBAC", "virtual_damping"): f"it is designed, and injection = 0 leaves it out; {_DAMPING}",
    ("Device", "mass"): _MASS,
    ("Mechanics", "mass"): _MASS,
    ("Device", "damping"): "give mechanics=ebac.Mechanics(damping=...)",
    ("Device", "friction"): "give mechanics=ebac.Mechanics(coulomb=...)",
    ("Device", "count"): "give encoder=ebac.Encoder(counts_per_turn=...), of the motor",
    ("Encoder", "count"): "give counts_per_turn, of the motor; device.count is that at the handle",
    ("Encoder", "resolution"): _RESOLUTION,
    ("Timing", "rate"): "give dt, 1/rate",
    ("Mesh", "path"): "did you mean 'file'",
    (
        "ebac.tune",
        "hands",
    ): "give training=ebac.Operators.sample(24, 14), 24 random hands of seed 14",
}


#: Other words for a name, where it is not one itself and none is near.
SYNONYMS = {
    "friction": "coulomb",
    "wall": "environment",
    "world": "environment",
    "arm": "hand",
    "operator": "hand",
    "duration": "seconds",
}


def require(value: Any, types: type | tuple[type, ...], function: str, wanted: str) -> None:
    """Raise TypeError unless a value is of one of the types; `wanted` names it for people. A word is no sequence."""
    kinds = types if isinstance(types, tuple) else (types,)
    word = isinstance(value, str) and Sequence in kinds and str not in kinds
    if word or not isinstance(value, kinds):
        raise TypeError(f"{function} takes {wanted}, not {shown(value)}")


def require_parts(owner: str, parts: Mapping[str, tuple[Any, type]]) -> None:
    """Raise TypeError for the first of the parts, each a value and its class, that is not of its class."""
    for name, (value, kind) in parts.items():
        if not isinstance(value, kind):
            raise TypeError(f"{owner}{name} = {shown(value)}: must be a {kind.__name__}")


def require_path(value: Any, function: str, wanted: str = "the path of a file") -> None:
    """Raise TypeError unless a value can be the path of a file."""
    require(value, (str, PathLike), function, wanted)


def require_file(value: Any, function: str) -> None:
    """Raise TypeError unless a value can be a path, FileNotFoundError or IsADirectoryError if it is that of no file."""
    require_path(value, function)
    if not Path(value).exists():
        raise FileNotFoundError(ENOENT, "there is no such file", str(value))
    if Path(value).is_dir():
        raise IsADirectoryError(EISDIR, "is a folder; give a file in it", str(value))


def whole(name: str, value: Any) -> int:
    """Return a whole number.

    Raises
    ------
    TypeError
        For anything else; the message names it.
    """
    if isinstance(value, bool):
        raise TypeError(f"{name} = {value!r}: must be a whole number")
    try:
        return index(value)
    except TypeError:
        raise TypeError(f"{name} = {value!r}: must be a whole number") from None


def plain(value: Any) -> Any:
    """Return a number of any kind, such as one of NumPy, as an int or a float; everything else as it is."""
    if isinstance(value, (bool, int)) or not isinstance(value, Real):
        return value
    return int(value) if isinstance(value, Integral) else float(value)


def number(name: str, value: Any) -> float:
    """Return a number.

    Raises
    ------
    TypeError
        For anything else; the message names it.
    ValueError
        For a whole number that is too large.
    """
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"{name} = {value!r}: must be a number")
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"{name} = {str(value)[:10]}...: is too large for a number") from None


def nearest_float(value: float) -> float:
    """Return a number as a float; a whole number beyond all floats is infinite, as the core has it."""
    try:
        return float(value)
    except OverflowError:
        return inf if value > 0 else -inf


def of_percent(value: float) -> str:
    """Return a remedy for a share that was given in per cent; "" for a value that cannot have been meant so."""
    return f"; {value:g} % is {value / 100:g}" if 1 < value <= 100 else ""


def keywords_only(
    names: Sequence[str], hint: Callable[[str], str] = lambda name: ""
) -> Callable[[Class], Class]:
    """Decorate a class whose constructor takes only these keywords.

    Parameters
    ----------
    names : sequence of str
        What the constructor takes.
    hint : function
        Returns where an unknown name belongs, or nothing.
    """

    def decorate(cls: Class) -> Class:
        construct: Any = getattr(cls, "__init__")  # noqa: B009

        @wraps(construct)
        def by_name(self: Any, *values: Any, **given: Any) -> None:
            if values:
                raise TypeError(
                    f"{cls.__name__} takes its parameters by name, not {shown(values[0])}; "
                    f"it has: {', '.join(names)}"
                )
            refuse_unknown(cls.__name__, given, names, hint)
            construct(self, **given)

        setattr(cls, "__init__", by_name)  # noqa: B010
        return cls

    return decorate


def near(name: object, known: Iterable[str]) -> list[str]:
    """Return up to three known names like one that is not known, the nearest first."""
    lower = {other.lower(): other for other in known}
    given = str(name).lower()
    if given in lower:
        return [lower[given]]
    close = difflib.get_close_matches(given, lower, 3)
    begun = [
        other
        for other in lower
        if len(given) > 2
        and any(part.startswith(given) for part in (other, other.rpartition(".")[2]))
    ]
    return [lower[other] for other in dict.fromkeys([*close, *begun])][:3]


def did_you_mean(name: object, known: Iterable[str], meant: Sequence[str] = ()) -> str:
    """Return those of `meant` that are known, or the nearest names, as the next words of a message; "" for none."""
    names = list(known)
    other = SYNONYMS.get(str(name), "")
    found = (
        [one for one in meant if one in names] or near(name, names) or [other] * (other in names)
    )
    quoted = [repr(one) for one in found]
    before, last = ", ".join(quoted[:-1]), "".join(quoted[-1:])
    return f", did you mean {f'{before} or {last}' if before else last}" if quoted else ""


def unknown(
    where: str, name: str, known: Iterable[str], kind: str = "", meant: Sequence[str] = ()
) -> str:
    """Return the message for a name that does not exist: the nearest that do, and where all are listed.

    Parameters
    ----------
    where : str
        What was given: an option with its value, a place in a file.
    name : str
        The name.
    known : iterable of str
        All that could have been given.
    kind : str
        What has names of this kind, as in `LISTED_BY`.
    meant : sequence of str
        Names it may stand for.
    """
    names = list(known)
    return f"{where}: no such name{did_you_mean(name, names, meant)}; {_all(names, kind)}"


def named(kind: str, name: object, known: Mapping[str, Value]) -> Value:
    """Return what has a name.

    Raises
    ------
    KeyError
        For a name that does not exist, worded as by `unknown`.
    """
    if not isinstance(name, str) or name not in known:
        raise unknown_name(kind, name, known)
    return known[name]


class UnknownNameError(KeyError):
    """A `KeyError` whose text is its message; that of a `KeyError` is the message in quotes."""

    def __str__(self) -> str:
        """Return the message."""
        return str(self.args[0]) if self.args else ""


def unknown_name(
    kind: str, name: object, known: Iterable[str], meant: Sequence[str] = ()
) -> KeyError:
    """Return the error for a name that does not exist, worded as by `unknown`; `meant` are names it may stand for."""
    names = list(known)
    return UnknownNameError(
        f"no {kind} is called {name!r}{did_you_mean(name, names, meant)}; {_all(names, kind)}"
    )


def _all(names: list[str], kind: str) -> str:
    if kind in LISTED_BY and len(names) > FEW:
        return f"`{LISTED_BY[kind]}` lists all"
    return f"there are: {', '.join(names)}"


def refuse_unknown(
    what: str,
    given: Mapping[str, Any],
    names: Sequence[str],
    hint: Callable[[str], str] = lambda name: "",
) -> None:
    """Raise TypeError for a name that is not taken, with a hint or the nearest name; bindings/fields.cpp calls it."""
    for name in given:
        if name in names:
            continue
        better = hint(name) or ELSEWHERE.get((what, name), "")
        more = f": {better}" if better else did_you_mean(name, names)
        has = f"it has: {', '.join(names)}" if names else "it has none: leave it out"
        raise TypeError(f"{what} has no parameter {name!r}{more}; {has}")


def shown(value: Any) -> str:
    """Return a value and its type for a message; a long one as its type alone, a class with what was meant."""
    if isinstance(value, type):
        return f"the class {value.__name__} (call it: {value.__name__}())"
    text = repr(value)
    return f"{text} ({type(value).__name__})" if len(text) <= 60 else type(value).__name__
