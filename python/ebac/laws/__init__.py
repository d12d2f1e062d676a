"""The laws by name, and how a law is made for a device."""

from ebac.laws.making import design
from ebac.laws.protocols import LAWS, CoreLaw, PythonLaw
from ebac.laws.variant import AnyLaw, Variant, changed, law_name

__all__ = [
    "LAWS",
    "AnyLaw",
    "CoreLaw",
    "PythonLaw",
    "Variant",
    "changed",
    "design",
    "law_name",
]


def __dir__() -> list[str]:
    return __all__
