"""Configurations of the drives of a gastroscopy that come with `ebac`."""

from __future__ import annotations

from importlib.resources import files
from typing import TYPE_CHECKING

from ebac._util.arguments import unknown_name

if TYPE_CHECKING:
    from ebac.hardware import Configuration

#: Time lost by a loop on simulated drives that is a fault [s].
PAUSE = 10.0


def configuration(part: str) -> Configuration:
    """Return a configuration that comes with `ebac`: "master", "feed" or "bend". `ebac demo` writes them.

    Parameters
    ----------
    part : str
        `master`, `feed` or `bend`.

    Raises
    ------
    KeyError
        For another name.
    """
    from ebac.hardware import Configuration

    parts = ("master", "feed", "bend")
    if part not in parts:
        raise unknown_name("configuration of a gastroscope", part, parts)
    text = (files("ebac.datasets") / f"gastroscope-{part}.toml").read_text(encoding="utf-8")
    return Configuration.from_toml(text, name=f"gastroscope-{part}.toml")
