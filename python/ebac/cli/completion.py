"""The names a shell completes options with. Each returns those that begin so."""

from __future__ import annotations


def laws(incomplete: str) -> list[str]:
    """Return the laws that begin so."""
    from ebac.laws import LAWS, tuned_laws

    return [name for name in (*LAWS, *tuned_laws(), "all") if name.startswith(incomplete.lower())]


def hands(incomplete: str) -> list[str]:
    """Return the hands that begin so."""
    from ebac.presets import HANDS

    return [name for name in HANDS if name.startswith(incomplete)]


def worlds(incomplete: str) -> list[str]:
    """Return the worlds that begin so."""
    from ebac.worlds import PRESETS

    return [name for name in (*PRESETS, "mesh:") if name.startswith(incomplete)]


def devices(incomplete: str) -> list[str]:
    """Return the devices that begin so."""
    from ebac.presets import DEVICES

    return [name for name in DEVICES if name.startswith(incomplete)]


def world_kinds(incomplete: str) -> list[str]:
    """Return the kinds of random worlds that begin so."""
    from ebac.studies.world_kinds import KINDS

    return [name for name in KINDS if name.startswith(incomplete)]


def world_devices(incomplete: str) -> list[str]:
    """Return the devices for random worlds that begin so."""
    from ebac.studies.random_scenario import DEVICES

    return [name for name in DEVICES if name.startswith(incomplete)]


def conditions(incomplete: str) -> list[str]:
    """Return the conditions and groups that begin so."""
    from ebac.studies import CONDITIONS, GROUPS

    return [name for name in (*GROUPS, *CONDITIONS) if name.startswith(incomplete)]
