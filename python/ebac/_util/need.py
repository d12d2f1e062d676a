"""Packages that few functions need, or a sentence that says how to install them."""

from __future__ import annotations

from importlib import import_module


def need(package: str, function: str) -> None:
    """Raise ImportError where a package, named as on PyPI, is not installed."""
    try:
        import_module(package)
    except ImportError as error:
        raise ImportError(f"{function} needs {package}: pip install {package}") from error
