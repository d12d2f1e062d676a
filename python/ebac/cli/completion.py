"""The names a shell completes options with. Each returns those that begin so; of a list, its last name."""

from __future__ import annotations

from collections.abc import Iterable


def _begun(incomplete: str, names: Iterable[str]) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def _last_begun(incomplete: str, names: Iterable[str]) -> list[str]:
    """Return lists separated by commas, with each name that the last one may become."""
    before, comma, last = incomplete.rpartition(",")
    return [f"{before}{comma}{name}" for name in _begun(last, names)]


def laws(incomplete: str) -> list[str]:
    """Return the laws that begin so."""
    from ebac.laws import LAWS, tuned_laws

    return _last_begun(incomplete.lower(), (*LAWS, *tuned_laws(), "all"))


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


def world_kinds(incomplete: str) -> list[str]:
    """Return the kinds of random worlds that begin so."""
    from ebac.studies.world_kinds import KINDS

    return _last_begun(incomplete, KINDS)


def world_devices(incomplete: str) -> list[str]:
    """Return the devices for random worlds that begin so."""
    from ebac.studies.random_scenario import DEVICES

    return _last_begun(incomplete, DEVICES)


def conditions(incomplete: str) -> list[str]:
    """Return the conditions and groups that begin so."""
    from ebac.studies import CONDITIONS, GROUPS

    return _last_begun(incomplete, (*GROUPS, *CONDITIONS))
