"""The names a shell completes options with. Each returns those that begin so; of a list, its last name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import wraps


def _begun(incomplete: str, names: Iterable[str]) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def several(complete: Callable[[str], list[str]]) -> Callable[[str], list[str]]:
    """Return a completion of lists separated by commas, whose last name is completed."""

    @wraps(complete)
    def last(incomplete: str) -> list[str]:
        before, comma, name = incomplete.rpartition(",")
        return [f"{before}{comma}{one}" for one in complete(name)]

    return last


@several
def laws(incomplete: str) -> list[str]:
    """Return the laws that begin so."""
    from ebac.laws import LAWS
    from ebac.laws.tuned_laws import tuned_laws

    return _begun(incomplete.lower(), (*LAWS, *tuned_laws(), "all"))


def hands(incomplete: str) -> list[str]:
    """Return the hands that begin so."""
    from ebac.presets import HANDS

    return _begun(incomplete, HANDS)


def worlds(incomplete: str) -> list[str]:
    """Return the worlds that begin so."""
    from ebac.worlds import PRESETS

    return _begun(incomplete, (*PRESETS, "mesh:"))


def devices(incomplete: str) -> list[str]:
    """Return the devices that begin so."""
    from ebac.presets import DEVICES

    return _begun(incomplete, DEVICES)


def presets(incomplete: str) -> list[str]:
    """Return the hands and devices that begin so."""
    return list(dict.fromkeys([*hands(incomplete), *devices(incomplete)]))


def keys(incomplete: str) -> list[str]:
    """Return the tables and kinds of files that begin so."""
    from ebac.cli.catalogue.keys import names
    from ebac.hardware.keys import file_keys

    return _begun(incomplete, names(file_keys()))


@several
def world_kinds(incomplete: str) -> list[str]:
    """Return the kinds of random worlds that begin so."""
    from ebac.studies.world_kinds import KINDS

    return _begun(incomplete, KINDS)


@several
def world_devices(incomplete: str) -> list[str]:
    """Return the devices for random worlds that begin so."""
    from ebac.studies.random_scenario import DEVICES

    return _begun(incomplete, DEVICES)


@several
def conditions(incomplete: str) -> list[str]:
    """Return the conditions and groups that begin so."""
    from ebac.studies import CONDITIONS, GROUPS

    return _begun(incomplete, (*GROUPS, *CONDITIONS))


def data_sets(incomplete: str) -> list[str]:
    """Return the data sets that begin so."""
    from ebac.datasets import DATASETS

    return _begun(incomplete, (*DATASETS, "all"))


def paper_items(incomplete: str) -> list[str]:
    """Return the items of the paper that begin so."""
    from ebac.paper import ITEMS

    return _begun(incomplete, (*ITEMS, "all"))


@several
def schemes(incomplete: str) -> list[str]:
    """Return the schemes of teleoperation that begin so."""
    from ebac.teleop import SCHEMES

    return _begun(incomplete, SCHEMES)


def one_of(*names: str) -> Callable[[str], list[str]]:
    """Return a completion of a few names."""
    return lambda incomplete: _begun(incomplete, names)
