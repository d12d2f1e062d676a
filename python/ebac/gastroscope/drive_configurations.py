"""Configurations of the drives of a gastroscopy that come with `ebac`."""

from __future__ import annotations

from importlib.resources import files
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.hardware import Configuration

#: A simulated device moves at most this many ticks from one tick to the next, however late its loop is.
LONGEST_STEP = 2
#: Ticks in a row without an answer, or too late, that simulated drives bear: their machine is not made for it.
PATIENCE = 200


def configuration(part: str) -> Configuration:
    """Return a configuration that comes with `ebac`: "master", "feed" or "bend". `ebac demo` writes them.

    Raises
    ------
    KeyError
        For another name.
    """
    from ebac.hardware import Configuration

    if part not in ("master", "feed", "bend"):
        raise KeyError(f"no configuration of a gastroscope is called {part!r}: master, feed, bend")
    text = (files("ebac.datasets") / f"gastroscope-{part}.toml").read_text(encoding="utf-8")
    return Configuration.from_toml(text, name=f"gastroscope-{part}.toml")


def patient(known: Configuration) -> Configuration:
    """Return the configuration with limits of time that a machine without real time keeps; for simulated drives."""
    limits = known.limits.replace(watch_motion=False, overruns=PATIENCE, pause=10.0, force_age=0.2)
    return known.replace(silent=PATIENCE, limits=limits)
