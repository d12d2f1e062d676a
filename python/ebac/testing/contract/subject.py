"""The law under test, however it was given, and what the tests feed it."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ebac._core import Device, DeviceFacts, Port, Timing
from ebac._util.arguments import unknown_name
from ebac.laws import LAWS, CoreLaw, PythonLaw, Variant, design, law_name
from ebac.laws.making import checked
from ebac.laws.protocols import is_core_law

if TYPE_CHECKING:
    from ebac.testing.contract import LawContract

Test = TypeVar("Test", bound=Callable[..., Any])


@dataclass(frozen=True, eq=False)
class Subject:
    """A law as a contract sees it.

    Attributes
    ----------
    given : law class, law, Variant, Python class or function
        What `law` of the contract names.
    name : str
        What it goes by.
    core : law class or None
        Its class, when it is one of the core or bound out of tree.
    passive : bool
        Whether its port may give out no energy.
    contract : subclass of LawContract
        Its test class.
    """

    given: Any
    name: str
    core: type[CoreLaw] | None
    passive: bool
    contract: type[LawContract]

    @classmethod
    def of(cls, law: Any, contract: type[LawContract]) -> Subject:
        """Look at what was given as a law."""
        if isinstance(law, str):
            if law not in LAWS:
                raise TypeError(unknown_name("law", law, LAWS).args[0])
            law = LAWS[law]
        made = _made(law, contract.device, Timing())
        core = type(made) if hasattr(made, "_simulate") else None
        own = bool(getattr(made, "passive", False))
        passive = own if contract.passive is None else contract.passive
        name = law.__name__ if isinstance(law, type) and core is None else law_name(made)
        return cls(law, name, core, passive, contract)

    @property
    def designed(self) -> bool:
        """Whether it can be designed for any device and timing."""
        kind = isinstance(self.given, (type, Variant))  # an object is made for one device
        return kind and (self.core is not None or hasattr(self.given, "design"))

    def made(self, timing: Timing | None = None, device: Device | DeviceFacts | None = None) -> Any:
        """Return a fresh law."""
        law = _made(self.given, device or self.contract.device, timing or Timing())
        law.reset()
        return law

    def lively(self) -> Any:
        """Return a fresh law with every memory it can have in use."""
        return self.contract.lively(self.made(Timing(delay=2)))


def _made(given: Any, device: Device | DeviceFacts, timing: Timing) -> Any:
    if isinstance(given, Variant) or (isinstance(given, type) and hasattr(given, "design")):
        return design(given, device, timing)
    if is_core_law(given):
        return given.replace(timing=timing)
    if isinstance(given, PythonLaw) and not isinstance(given, type):
        law = copy.deepcopy(given)
    elif callable(given):
        try:
            law = given()
        except TypeError as error:
            if isinstance(given, type) and "argument" in str(error):
                name = given.__name__
                error.add_note(
                    f"A contract makes the law without arguments: write law = lambda: {name}(...), or "
                    f"give {name} a classmethod design(facts, timing)."
                )
            raise
    else:
        law = given
    return checked(law)


def of_core(test: Test) -> Test:
    """Ask only laws of C++: they have a field list, a recorded state and a copy of their own."""
    test.needs = lambda subject: subject.core is not None  # type: ignore[attr-defined]
    return test


def of_passive(test: Test) -> Test:
    """Test only laws declared passive."""
    test.needs = lambda subject: subject.passive  # type: ignore[attr-defined]
    return test


def bits(value: float) -> str:
    """Return a number in the shortest digits that give it back to the bit, so that a difference can be read."""
    return repr(float(value))


def random_ports(seed: int, n: int = 400, start: float = 0.0, drift: int = 0) -> list[Port]:
    """Return a wandering handle in and out of a stiff wall, on whole encoder counts, with standstills."""
    random = np.random.default_rng(seed)
    count = Device().count
    steps = (random.integers(-6, 7, n) + drift) * (random.random(n) < 0.7)
    steps[0] = 0
    ports, x = [], start
    for k, step in enumerate(steps):
        dx = float(step) * count
        x += dx
        ports.append(
            Port(
                x=x,
                dx=dx,
                v=dx / 1e-3,
                dt=1e-3 if k else 0.0,
                f_env=max(0.0, 1e4 * x),
                f_applied=float(random.normal(0, 5)),
                f_meas=float(random.normal(0, 5)),
            )
        )
    return ports


def state_of(law: Any) -> str:
    """Return the recorded state; a NaN equals itself in text. A law in Python has none."""
    return repr(law.state.as_dict()) if hasattr(law, "_simulate") else ""


def drive(law: Any, ports: list[Port]) -> list[tuple[str, str]]:
    """Return force [N] and state after each step, to the bit."""
    return [(bits(law.step(port)), state_of(law)) for port in ports]
