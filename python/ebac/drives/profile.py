"""Drive profiles: what a drive is to be set to, in TOML, in SI units."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Any, Self

from ebac._util.text_file import read_text
from ebac._util.wrong_calls import plain_constructor
from ebac.drives.errors import ProfileError
from ebac.drives.load import Traffic
from ebac.drives.pdo import Pdo, read_pdo, sync_period
from ebac.drives.profile_fields import BY_NAME, KEYS, RULES, Value
from ebac.drives.toml_positions import Path as Where
from ebac.drives.toml_positions import Source, dotted

#: Tables of a profile that hold keys; `pdo` and `about` are read apart.
TABLES = tuple(dict.fromkeys(key.name.partition(".")[0] for key in KEYS))


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

    def __post_init__(self) -> None:
        """Check what must hold between keys, where no file is to blame."""
        defaults = {key.name: key.default for key in KEYS if key.default is not None}
        for name, value in self.values.items():
            key = BY_NAME.get(name)
            if key is None:
                from ebac._util.serialisation import unknown

                raise ProfileError(f"{self.name}: {unknown(name, name, list(BY_NAME))}")
            if (wrong := key.check(value)) is not None:
                raise ProfileError(f"{self.name}: {wrong}")
        values = MappingProxyType({**defaults, **self.values})
        object.__setattr__(self, "values", values)
        for name, wrong in _broken(values):
            raise ProfileError(f"{self.name}: {wrong} (key {name})")

    def replace(self, **values: Value) -> Self:
        """Return a copy with some values changed, dots written as two underscores.

        Examples
        --------
        >>> load("copley-accelnet").profile.replace(motor__torque_constant=0.06)  # doctest: +SKIP
        """
        changes = {name.replace("__", "."): value for name, value in values.items()}
        return dataclasses.replace(self, values={**self.values, **changes})

    def with_deadline(self, seconds: float) -> Self:
        """Return a copy whose drive waits at least `seconds` for each torque it has a deadline for."""
        pdos = tuple(
            dataclasses.replace(pdo, event=max(pdo.event, seconds))
            if pdo.event > 0 and not pdo.sent
            else pdo
            for pdo in self.pdos
        )
        return dataclasses.replace(self, pdos=pdos)

    def traffic(self, node: int) -> list[Traffic]:
        """Return the frames of a node that come again and again."""
        frames = [pdo.traffic(node, sync_period(self.values)) for pdo in self.pdos]
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
            f"{path}: there is no such file, and no profile of that name; there are: {known}"
        ) from None
    except (OSError, ValueError) as error:  # ValueError: no text, or no name of a file
        raise ProfileError(f"{str(path)!r}: cannot be read ({error})") from None


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
    for name, wrong in _broken({**defaults, **merged}):
        key: Where = (*at, *name.split("."))
        raise source.refuse(key, wrong)
    pdos = {pdo.name: pdo for pdo in base.pdos} if base else {}
    silence = base.silence if base else True
    if "pdo" in table and not at:
        silence = _others(source, table["pdo"])
        pdos |= {
            name: read_pdo(source, name, item)
            for name, item in table["pdo"].items()
            if name != "others"
        }
    about = table.get("about", base.about if base else "")
    if not isinstance(about, str):
        raise source.refuse((*at, "about"), f"about = {about!r}: must be text")
    return Profile(
        name=base.name if base else source.name.removesuffix(".toml"),
        about=about,
        values=merged,
        pdos=tuple(pdos.values()),
        silence=silence,
    )


def _values(source: Source, table: Mapping[str, Any], at: Where) -> Iterator[tuple[str, Value]]:
    from ebac._util.serialisation import unknown

    apart = ("about", "pdo") if not at else ("id", "name", "profile")
    for title, item in table.items():
        if title in apart:
            continue
        if title not in TABLES:
            here = dotted((*at, title))
            raise source.refuse((*at, title), unknown(here, title, [*apart, *TABLES]))
        if not isinstance(item, Mapping):
            raise source.refuse((*at, title), f"{dotted((*at, title))} = {item!r}: must be a table")
        names = [key.name.partition(".")[2] for key in KEYS if key.name.startswith(f"{title}.")]
        for name, value in item.items():
            path = (*at, title, name)
            if name not in names:
                raise source.refuse(path, unknown(dotted(path), name, names))
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


def _broken(values: Mapping[str, Value]) -> Iterator[tuple[str, str]]:
    """Yield the keys that do not fit the others, or the drive, and what is wrong."""
    for holds, name, wrong in RULES:
        if not holds(values):
            key = BY_NAME[name]
            yield name, f"{name} = {key.show(values[name])}: {wrong}"
    for name, value in values.items():
        key = BY_NAME[name]
        if key.whole or key.choices or (key.per and key.per not in values):
            continue
        try:
            key.raw(value, values)
        except ValueError as error:
            yield name, str(error)
