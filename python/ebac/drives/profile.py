"""Drive profiles: what a drive is to be set to, in TOML, in SI units."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from functools import partial
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Any, Self

from ebac._util.arguments import plain, unknown
from ebac._util.text_file import read_text
from ebac._util.wrong_calls import plain_constructor
from ebac.drives.errors import ProfileError
from ebac.drives.load import Traffic
from ebac.drives.objects import Object, find
from ebac.drives.own_objects import following, read_objects, read_vendor
from ebac.drives.pdo import Pdo, read_pdo, sync_period
from ebac.drives.profile_fields import BY_NAME, KEYS, RULES, Value
from ebac.drives.setting import Setting
from ebac.drives.toml_positions import Path as Where
from ebac.drives.toml_positions import Source

#: Tables of a profile that hold keys; `pdo` and `about` are read apart.
TABLES = tuple(dict.fromkeys(key.name.partition(".")[0] for key in KEYS))
#: Keys of what a drive watches of the loop beside its torques: its heartbeat, or its requests (node guarding).
SIGNS_OF_LIFE = ("heartbeat.consumer", "heartbeat.guard")
#: Requests of node guarding in the time for which a drive waits for one.
REQUESTS = 5


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Profile:
    """What a drive is to be set to.

    Parameters
    ----------
    name : str
        For people.
    about : str
        Which drives it is for.
    values : mapping
        Key of a profile ("motor.torque_constant") to value, SI units.
    pdos : tuple of Pdo
        What it exchanges with the loop.
    silence : bool
        Whether PDOs that are not listed are switched off.
    objects : tuple of Setting
        Objects of the maker's own, and their raw numbers.
    without : tuple of str
        Keys whose object the drive does not have: they scale others and are not written.
    vendor : int
        The maker's number (0x1018:1), which a simulated drive takes; 0 for any maker.

    Raises
    ------
    ProfileError
        When values do not fit each other.
    """

    name: str
    about: str = ""
    values: Mapping[str, Value]
    pdos: tuple[Pdo, ...] = ()
    silence: bool = True
    objects: tuple[Setting, ...] = ()
    without: tuple[str, ...] = ()
    vendor: int = 0

    def __post_init__(self) -> None:
        """Check what must hold between keys, where no file is to blame."""
        defaults = {key.name: key.default for key in KEYS if key.default is not None}
        given = {name: plain(value) for name, value in self.values.items()}
        for name, value in given.items():
            key = BY_NAME.get(name)
            if key is None:
                raise ProfileError(f"{self.name}: {unknown(name, name, list(BY_NAME))}")
            if (wrong := key.check(value)) is not None:
                raise ProfileError(f"{self.name}: {wrong}")
        values = MappingProxyType({**defaults, **given})
        object.__setattr__(self, "values", values)
        for name, wrong in _broken(values, self.without):
            raise ProfileError(f"{self.name}: {wrong} (key {name})")
        for name in self.without:
            if (wrong := _not_without(name)) is not None:
                raise ProfileError(f"{self.name}: {wrong}")
        try:
            objects = tuple(following(one, values) for one in self.objects)
        except ValueError as error:
            raise ProfileError(f"{self.name}: objects: {error}") from None
        object.__setattr__(self, "objects", objects)
        if self._unbounded():
            raise ProfileError(
                f"{self.name}: without names every limit of torque and current: the drive would allow any; give the "
                "maker's own limit under [objects]"
            )

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how it is made again: its values cannot be copied as they are, they are read-only."""
        given = {one.name: getattr(self, one.name) for one in fields(self)}
        return partial(type(self), **{**given, "values": dict(self.values)}), ()

    def _unbounded(self) -> bool:
        limits = ("limits.max_torque", "limits.max_current")
        given = [name for name in limits if name in self.values]
        return bool(given) and set(given) <= set(self.without) and not self.objects

    def absent(self) -> list[tuple[Object, str]]:
        """Return the objects a drive must not have, and the key of each."""
        own = {one.object.key for one in self.objects}
        pairs = [(find(BY_NAME[name].sets), name) for name in self.without]
        return [pair for pair in pairs if pair[0].key not in own]

    def replace(self, **values: Value) -> Self:
        """Return a copy with some values changed, dots written as two underscores.

        Examples
        --------
        >>> load("copley-accelnet").profile.replace(motor__torque_constant=0.06)  # doctest: +SKIP
        """
        changes = {name.replace("__", "."): value for name, value in values.items()}
        return dataclasses.replace(self, values={**self.values, **changes})

    def with_patience(self, *, torque: float, heartbeat: float = 0.0) -> Self:
        """Return a copy whose drive waits at least so long [s] for a torque, heartbeat or request that it watches."""
        pdos = tuple(
            dataclasses.replace(pdo, event=max(pdo.event, torque))
            if pdo.event > 0 and not pdo.sent
            else pdo
            for pdo in self.pdos
        )
        watched = {key: float(self.values.get(key, 0.0)) for key in SIGNS_OF_LIFE}
        patient = {key: heartbeat for key, value in watched.items() if 0 < value < heartbeat}
        return dataclasses.replace(self, pdos=pdos, values={**self.values, **patient})

    def traffic(self, node: int) -> list[Traffic]:
        """Return the frames of a node that come again and again."""
        frames = [pdo.traffic(node, sync_period(self.values)) for pdo in self.pdos]
        if guard := float(self.values.get("heartbeat.guard", 0.0)):
            return [
                *frames,
                Traffic(name=f"guarding of node {node}", size=1, rate=2 * REQUESTS / guard),
            ]
        beat = float(self.values["heartbeat.producer"])
        return [*frames, Traffic(name=f"heartbeat of node {node}", size=1, rate=1 / beat)]


def builtin() -> list[str]:
    """Return the names of the profiles and network files that come with the package."""
    return sorted(
        item.name.removesuffix(".toml")
        for item in files("ebac.drives").joinpath("profiles").iterdir()
        if item.name.endswith(".toml")
    )


def read_source(name: str | Path) -> Source:
    """Return a profile or network file, by path, or by name where it comes with the package.

    Raises
    ------
    ProfileError
        When there is none, or it is no TOML.
    """
    if str(name) in builtin():
        item = files("ebac.drives").joinpath("profiles", f"{name}.toml")
        return Source(name=f"{name}.toml", text=item.read_text(encoding="utf-8"))
    path = Path(name)
    try:
        return Source(name=str(path), text=read_text(path))
    except FileNotFoundError:
        known = ", ".join(builtin())
        raise ProfileError(
            f"{path}: there is no such file, and no profile of that name; there are: {known}. For another drive write "
            "a profile: `ebac drive profile generic-cia402` prints one to start from"
        ) from None
    except (OSError, ValueError) as error:  # ValueError: no text, or no name of a file
        why = getattr(error, "strerror", None) or error
        raise ProfileError(f"{str(path)!r}: cannot be read ({why})") from None


def read_profile(source: Source, *, base: Profile | None = None, at: Where = ()) -> Profile:
    """Return the profile in a document, or in one of its tables, on top of another.

    Parameters
    ----------
    source : Source
        The document.
    base : Profile, optional
        What is not named keeps its value.
    at : tuple
        Where in the document the profile stands.

    Raises
    ------
    ProfileError
        For what cannot be; the message names file, line, key, value, unit, range and remedy.
    """
    table: Any = source.table
    for part in at:
        table = table[part]
    given = dict(_values(source, table, at))
    merged: dict[str, Value] = {**(base.values if base else {}), **given}
    defaults = {key.name: key.default for key in KEYS if key.default is not None}
    without = _without(source, table, at) if "without" in table else base.without if base else ()
    for name, wrong in _broken({**defaults, **merged}, without):
        key: Where = (*at, *name.split("."))
        raise source.refuse(key, wrong)
    if base is None and not any(table.get(title) for title in (*TABLES, "pdo", "objects")):
        raise ProfileError(
            f"{source.name}: sets nothing: a profile needs tables such as [limits] and [pdo.rpdo1]; `ebac drive "
            "profile generic-cia402` prints one to start from"
        )
    pdos = {pdo.name: pdo for pdo in base.pdos} if base else {}
    silence = base.silence if base else True
    if "pdo" in table and not at:
        silence = _others(source, table["pdo"])
        pdos |= {
            name: read_pdo(source, name, item)
            for name, item in table["pdo"].items()
            if name != "others"
        }
    owned = {one.object.key: one for one in base.objects} if base else {}
    if "objects" in table:
        taken = {key.sets: key.name for key in KEYS if key.sets and key.name not in without}
        new = read_objects(
            source, table["objects"], (*at, "objects"), taken, {**defaults, **merged}
        )
        owned |= {one.object.key: one for one in new}
    about = table.get("about", base.about if base else "")
    if not isinstance(about, str):
        raise source.refuse((*at, "about"), f"about = {about!r}: must be text")
    return Profile(
        name=base.name if base else source.name.removesuffix(".toml"),
        about=about,
        values=merged,
        pdos=tuple(pdos.values()),
        silence=silence,
        objects=tuple(owned.values()),
        without=without,
        vendor=read_vendor(source, table, base.vendor if base else 0),
    )


def _without(source: Source, table: Mapping[str, Any], at: Where) -> tuple[str, ...]:
    given, path = table["without"], (*at, "without")
    if not isinstance(given, list) or not all(isinstance(name, str) for name in given):
        raise source.refuse(path, f"without = {given!r}: must be a list of keys")
    for name in given:
        if (wrong := _not_without(name)) is not None:
            raise source.refuse(path, wrong)
    return tuple(dict.fromkeys(given))


def _not_without(name: str) -> str | None:
    """Return why a drive must have the object of a key; None where it may lack it."""
    may = [key.name for key in KEYS if key.sets and key.name != "torque.mode"]
    if name in BY_NAME and name not in may:
        return f"without: {name}: every drive needs it, or it sets no object; leave it out of the profile instead"
    return None if name in may else f"without: {unknown(name, name, may)}"


def _values(source: Source, table: Mapping[str, Any], at: Where) -> Iterator[tuple[str, Value]]:
    own = ("objects", "without")
    apart = ("about", "vendor", "pdo", *own) if not at else ("id", "name", "profile", "eds", *own)
    for title, item in table.items():
        if title in apart:
            continue
        if title not in TABLES:
            raise source.refuse((*at, title), unknown(title, title, [*apart, *TABLES]))
        if not isinstance(item, Mapping):
            raise source.refuse((*at, title), f"{title} = {item!r}: must be a table")
        names = [key.name.partition(".")[2] for key in KEYS if key.name.startswith(f"{title}.")]
        for name, value in item.items():
            path = (*at, title, name)
            if name not in names:
                raise source.refuse(path, unknown(f"{title}.{name}", name, names))
            key = BY_NAME[f"{title}.{name}"]
            if (wrong := key.check(value)) is not None:
                raise source.refuse(path, wrong)
            yield key.name, value


def _others(source: Source, table: Any) -> bool:
    if not isinstance(table, Mapping):
        raise source.refuse(("pdo",), f"pdo = {table!r}: must be a table")
    others = table.get("others", "off")
    if others not in ("off", "keep"):
        raise source.refuse(("pdo", "others"), f'pdo.others = {others!r}: must be "off" or "keep"')
    return bool(others == "off")


def _broken(values: Mapping[str, Value], without: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Yield the keys that do not fit the others, or the drive, and what is wrong.

    A key under `without` sets no object of its unit: its value only has to fit the units of what follows from it
    (`own_objects.following`).
    """
    for holds, name, wrong in RULES:
        if not holds(values):
            key = BY_NAME[name]
            what = wrong if isinstance(wrong, str) else wrong(values)
            yield name, f"{name} = {key.show(values[name])}: {what}"
    for name, value in values.items():
        key = BY_NAME[name]
        if name in without or key.whole or key.choices or (key.per and key.per not in values):
            continue
        try:
            key.raw(value, values)
        except ValueError as error:
            yield name, str(error)
