"""A law in all its forms: a name, a class, a finished law, or one with parameters changed."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, TypeAlias, cast

from ebac._util.arguments import refuse_unknown, require, unknown_name
from ebac._util.code_print import ADDRESS
from ebac._util.wrong_calls import plain_constructor
from ebac.laws.protocols import LAWS, CoreLaw, PythonLaw, is_core_law
from ebac.laws.tuned_laws import tuned_laws


@plain_constructor
@dataclasses.dataclass(frozen=True)
class Variant:
    """A law with parameters changed on top of its design, designed again wherever the law would be.

    Attributes
    ----------
    law : str or law class
        A name of `LAWS`, or a class of the core.
    changes : mapping
        Parameters by name, in their SI units.

    Raises
    ------
    KeyError
        For a name that is no law.
    ValueError
        For a parameter out of range.
    TypeError
        For something that is no law, a parameter that it does not have, or a value of a wrong type.
    """

    law: str | type[CoreLaw]
    changes: Mapping[str, Any]

    def __post_init__(self) -> None:
        """Check law and changes."""
        require(self.changes, Mapping, "ebac.Variant", "changes by name, as in {'kp': 0.2}")
        wanted = "a law of ebac.LAWS or its class"
        own = self.law if isinstance(self.law, type) else type(self.law)
        if self.changes and hasattr(own, "step") and not hasattr(own, "_simulate"):
            made = f"{own.__name__}({', '.join(f'{name}=...' for name in self.changes)})"
            raise TypeError(
                f"ebac.Variant takes {wanted}; make a law of your own with other arguments, {made}"
            )
        require(self.law, (str, type), "ebac.Variant", wanted)
        kind = class_of(self.law)
        refuse_unknown(kind.__name__, self.changes, [field.name for field in kind.fields()])
        kind(**self.changes)

    @property
    def name(self) -> str:
        """The law's name and its changes: "ebac, guard = off"."""
        return ", ".join(
            [law_name(self.law), *(f"{n} = {shown_value(v)}" for n, v in self.changes.items())]
        )


AnyLaw: TypeAlias = str | type[CoreLaw] | type[PythonLaw] | CoreLaw | PythonLaw | Variant


def changed(law: AnyLaw, **changes: Any) -> AnyLaw:
    """Return a law with some parameters changed, to be used wherever the law can be.

    Parameters
    ----------
    law : str, law class, Variant, law or PythonLaw
        What is designed stays so, as a `Variant`; a finished law is copied, one in Python when it is a dataclass.
    **changes
        Parameters in their SI units.

    Raises
    ------
    TypeError
        For a law in Python that is no dataclass, a parameter that it does not have, or a value of a wrong type.
    ValueError
        For a value outside the range of its parameter, which a law in Python declares in its fields.
    """
    if isinstance(law, Variant):
        return Variant(law.law, {**law.changes, **changes})
    if isinstance(law, (str, type)):
        return Variant(cast("str | type[CoreLaw]", law), changes)
    if is_core_law(law):
        return law.replace(**changes)
    if not hasattr(law, "__dataclass_fields__"):
        raise TypeError(
            f"the law {law_name(law)} has no parameters to change: those of a law in Python are the fields of a "
            "dataclass; put @dataclass above its class"
        )
    from ebac.laws.law_fields import as_declared  # which needs this module

    own: Any = law
    refuse_unknown(type(law).__name__, changes, [one.name for one in dataclasses.fields(own)])
    return cast(PythonLaw, dataclasses.replace(own, **as_declared(own, changes)))


def class_of(law: str | type) -> type[CoreLaw]:
    """Return the class of a law, which may go by its name or that of one with tuned parameters."""
    if isinstance(law, str):
        name = law.partition("-tuned")[0] if law in tuned_laws() else law
        place, colon, own = name.rpartition(":")
        if colon:
            module = place.rpartition("/")[2].removesuffix(".py")
            raise ValueError(
                f"law = {law!r}: the option --law takes FILE.py:CLASS; in Python give an object of the class: "
                f"from {module} import {own}, and {own}() in place of {law!r}"
            )
        if name not in LAWS:
            raise unknown_name("law", law, [*LAWS, *tuned_laws()])
        return LAWS[name]
    if not hasattr(law, "_simulate"):
        name = law.__name__
        design = (
            "" if hasattr(law, "design") else ", or give it a classmethod design(facts, timing)"
        )
        raise TypeError(f"{name} is a class: give an instance of it, {name}(...){design}")
    return cast("type[CoreLaw]", law)


def law_name(law: AnyLaw) -> str:
    """Return the name a law goes by in tables and plots.

    Parameters
    ----------
    law : str, type or law
        A name, a law or a `Variant`.
    """
    if isinstance(law, str):
        return law
    kind = law if isinstance(law, type) else type(law)
    return str(getattr(law, "name", kind.__name__))


def law_text(law: CoreLaw | PythonLaw) -> str:
    """Return a finished law with its parameters, as files keep it: the same text in every run.

    A law in Python without a `__repr__` of its own is its class and its public fields.
    """
    text = repr(law)
    if type(law).__repr__ is object.__repr__:
        fields = [
            (name, value)
            for name, value in getattr(law, "__dict__", {}).items()
            if not name.startswith("_")
        ]
        text = f"{type(law).__name__}({', '.join(f'{name}={value!r}' for name, value in fields)})"
    return ADDRESS.sub("", text)


def shown_value(value: bool | float) -> str:
    """Return a parameter's value as people read it: on, off or a number."""
    return ("on" if value else "off") if isinstance(value, bool) else f"{value:g}"
