"""Values of the core as plain tables, for TOML and JSON, and back.

A part that may be of several types carries its type's name under `type`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from typing import Any

from ebac import _core
from ebac._util.arguments import ELSEWHERE, unknown
from ebac._util.misplaced import Misplaced, Path, misplaced
from ebac._util.signatures import refuse_names

#: Solids of the core.
SHAPES = (_core.Box, _core.Capsule, _core.Cylinder, _core.Plane, _core.Sphere, _core.Torus)
#: Solids of a world.
SOLIDS: tuple[type | str, ...] = (
    *SHAPES,
    *(f"ebac.worlds.{name}" for name in (
        "Placed", "Cavity", "Textured", "Tube", "Union", "Intersection", "Difference", "Mesh", "HeightField",
    )),
)  # fmt: skip
#: Types a part may have, by the name of the part; the first is the default. One that is imported when it is needed
#: stands there by its name.
CHOICES: dict[str, tuple[type | str, ...]] = {
    "kinematics": (_core.Linear, _core.Gimbal, _core.SlidingGimbal),
    "velocity": (_core.BackwardDifference, _core.LowPass, _core.AdaptiveWindow),
    "path": (_core.Step, _core.MinimumJerk, _core.Sine, _core.Tapping, _core.Recorded),
    "environment": (
        _core.Wall,
        _core.Free,
        _core.Corner,
        _core.Disc,
        "ebac.worlds.World",
        "ebac.worlds.Bridge",
    ),
    "world": ("ebac.worlds.World",),
    "engine_timing": (_core.EngineTiming,),
    "rendering": (_core.BridgeParams,),
    "bodies": ("ebac.worlds.Body",),
    "solid": SOLIDS,
    "solids": SOLIDS,
    "material": (_core.Elastic, _core.HuntCrossley, "ebac.worlds.Layered"),
    "layers": (_core.Layer,),
    "motion": (_core.Swing,),
    "texture": (_core.Texture,),
    "device": (_core.Device,),
    "hand": (_core.Hand,),
    "model": (_core.Reflex, _core.FingerPad, _core.NonlinearGrip, _core.LetGo),
    "timing": (_core.Timing,),
    "observer": (_core.Observer,),
    "motor": (_core.Motor,),
    "drive": (_core.Drive,),
    "encoder": (_core.Encoder,),
    "capstan": (_core.Capstan,),
    "mechanics": (_core.Mechanics,),
    "sensor": (_core.ForceSensor,),
    "compensation": (_core.Compensation,),
    "first": (_core.Wall,),
    "second": (_core.Wall,),
}

#: Plain values that a part of that name may have instead: an observer on, off or for every law, the name of a
#: sensor's model.
PLAIN: dict[str, tuple[type, ...]] = {"observer": (bool, str), "model": (str,)}


def to_document(value: Any) -> Any:
    """Return a value of the core as nested plain tables, lists and numbers."""
    if isinstance(value, (list, tuple)):
        return [to_document(item) for item in value]
    if not hasattr(value, "as_dict"):
        return value
    table = {name: to_document(part) for name, part in value.as_dict().items()}
    name = type(value).__name__
    several = any(name in map(_name_of, types) for types in CHOICES.values() if len(types) > 1)
    return {"type": name, **table} if several else table


def from_document(name: str, item: Any, path: Path) -> Any:
    """Return the value of the core that `item` describes, where `name` gives what it may be.

    Raises
    ------
    Misplaced
        For an unknown name or type or a number out of range.
    """
    if name not in CHOICES or isinstance(item, PLAIN.get(name, ())):
        return item
    if isinstance(item, list):
        return tuple(from_document(name, one, (*path, i)) for i, one in enumerate(item))
    if not isinstance(item, Mapping):
        without = (
            "; a device without a sensor has `fitted = false` in it" if name == "sensor" else ""
        )
        raise Misplaced(path, f" = {item!r}: must be a table{without}")
    return _build(_chosen(name, item, path), item, path)


def on_top(base: Any, table: Mapping[str, Any], path: Path, *, apart: Iterable[str] = ()) -> Any:
    """Return a value of the core with the parts that a table names on top of it.

    Parameters
    ----------
    base : value of the core
        What is not named keeps its value.
    table : mapping
        The table.
    path : tuple of str or int
        Where it stands.
    apart : iterable of str
        Keys of the table that mean something else.

    Raises
    ------
    Misplaced
        For an unknown name or type or a number out of range.
    """
    parts, others = base.as_dict(), list(apart)
    if isinstance(base, _core.Hand):
        parts.setdefault("model", None)  # a hand without one may get one
    refuse_keys(table, [*parts, *others], path, type(base).__name__)
    changes = {}
    for name, item in table.items():
        if name in others:
            continue
        here, part = (*path, name), parts[name]
        nested = isinstance(item, Mapping) and hasattr(part, "as_dict") and "type" not in item
        changes[name] = on_top(part, item, here) if nested else from_document(name, item, here)
    try:
        return base.replace(**changes)
    except (ValueError, TypeError) as error:
        raise misplaced(path, table, error) from None


def on_its_preset(make: Callable[[str], Any], table: Mapping[str, Any], path: Path) -> Any:
    """Return what `make` returns for the table's `preset`, with the rest of the table on top of it.

    Raises
    ------
    Misplaced
        For an unknown preset or name or a number out of range.
    """
    try:
        base = make(str(table["preset"]))
    except KeyError as error:
        raise Misplaced((*path, "preset"), f": {error.args[0]}") from None
    return on_top(base, table, path, apart=["preset"])


def read_table(table: Mapping[str, Any], fields: Iterable[Any], path: Path) -> dict[str, Any]:
    """Return the keyword arguments of a dataclass with these `fields` from a table.

    Raises
    ------
    Misplaced
        For an unknown name; the message suggests the nearest.
    """
    refuse_keys(table, [f.name for f in fields], path)
    return {name: from_document(name, item, (*path, name)) for name, item in table.items()}


def refuse_keys(table: Mapping[str, Any], known: Sequence[str], path: Path, kind: str = "") -> None:
    """Raise Misplaced for a key that is not known; `kind` is the class that takes them."""
    for name in table:
        if name not in known:
            better = ELSEWHERE.get((kind, name))
            law = getattr(getattr(_core, kind, None), "name", None)
            first = f"{law} has no parameter {name}; " if isinstance(law, str) else ""
            what = f": {first}{better}" if better else unknown("", name, known)
            raise Misplaced((*path, name), what)


def _chosen(name: str, table: Mapping[str, Any], path: Path) -> type:
    types = {_name_of(kind): kind for kind in CHOICES[name]}
    wanted = table.get("type", next(iter(types)))
    if not isinstance(wanted, str) or wanted not in types:
        raise Misplaced((*path, "type"), unknown(f" = {wanted!r}", str(wanted), types))
    kind = types[wanted]
    return _imported(kind) if isinstance(kind, str) else kind


def _name_of(kind: type | str) -> str:
    return kind.rpartition(".")[2] if isinstance(kind, str) else kind.__name__


def _imported(path: str) -> type:
    module, _, name = path.rpartition(".")
    kind: type = getattr(import_module(module), name)
    return kind


def _build(cls: type, table: Mapping[str, Any], path: Path) -> Any:
    own = {name: item for name, item in table.items() if name != "type"}
    made: Any = getattr(cls, "from_table", cls)
    try:
        refuse_names(cls.__name__, made, own)
        return made(
            **{name: from_document(name, item, (*path, name)) for name, item in own.items()}
        )
    except (ValueError, TypeError) as error:
        raise misplaced(path, table, error) from None
