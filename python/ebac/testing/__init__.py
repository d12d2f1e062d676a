"""What a project needs to test its controller: claims on traces, golden traces, a law's contract, strategies.

`LawContract` needs pytest and hypothesis, `strategies` needs hypothesis; both are loaded when first asked for. The
fixture `ebac_trace` comes with the pytest plugin.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ebac.testing.claims import (
    assert_force_continuous,
    assert_passive,
    assert_settles,
    assert_within_limits,
)
from ebac.testing.compare import Comparison, Divergence, compare
from ebac.testing.tolerance import Tolerance, default_tolerance

if TYPE_CHECKING:
    from ebac.testing import strategies
    from ebac.testing.contract import LawContract

__all__ = [
    "Comparison",
    "Divergence",
    "LawContract",
    "Tolerance",
    "assert_force_continuous",
    "assert_passive",
    "assert_settles",
    "assert_within_limits",
    "compare",
    "default_tolerance",
    "strategies",
]


def __dir__() -> list[str]:
    return __all__


def __getattr__(name: str) -> Any:
    if name not in ("LawContract", "strategies"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    try:
        if name == "LawContract":
            return import_module("ebac.testing.contract").LawContract
        return import_module("ebac.testing.strategies")
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            f"ebac.testing.{name} needs {error.name}: pip install pytest hypothesis",
            name=error.name,
        ) from error
