"""What every law promises, as a class of tests to inherit.

Write this into a test file, and pytest runs the whole suite on your law::

    from ebac.testing import LawContract

    class TestMyLaw(LawContract):
        law = MyLaw
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import pytest

from ebac._core import Device
from ebac.testing.contract.agreement import Agreement
from ebac.testing.contract.memory import Memory
from ebac.testing.contract.numbers import Numbers
from ebac.testing.contract.parameters import FieldContract, ParameterContract
from ebac.testing.contract.passivity import Passivity
from ebac.testing.contract.subject import Subject

__all__ = ["FieldContract", "LawContract", "Subject"]


class LawContract(Memory, Numbers, ParameterContract, Agreement, Passivity):
    """The contract of a law; a subclass names the law and runs every test on it.

    A law of C++ is tested with all of it. A law in Python has neither a field list nor a recorded state; what would
    need them is left out. What is declared passive, and only that, must survive a hostile world.

    Attributes
    ----------
    law : str, law class, law, Python class, or function without arguments that makes a law
        The one to test. A Python class with `design(facts, timing)` is designed for each device and timing; any other
        is made without arguments, an object is copied.
    laws : sequence
        Several, instead of `law`.
    passive : bool or None
        Whether no energy may leave its port; None takes the law's own `passive`, where it has one.
    holds_force : bool
        Whether it may keep a force at rest in free air that it built up before.
    device : Device
        For which it is designed; default: the reference device.
    timing_of_law : Timing
        The timing a Python law without `design` is made for; default: 1 ms, 1 sample of delay.
    """

    law: ClassVar[Any] = None
    laws: ClassVar[Sequence[Any]] = ()
    passive: ClassVar[bool | None] = None
    holds_force: ClassVar[bool] = False
    device: ClassVar[Device] = Device()
    _left_out: ClassVar[dict[str, Any]] = {}

    def __init_subclass__(cls, **more: Any) -> None:
        """Leave out what no law of the class can be asked."""
        super().__init_subclass__(**more)
        if cls.law is None and not cls.laws:
            return
        subjects = cls.subjects()
        for base in cls.__mro__[1:]:  # what a contract in between has left out is asked again
            for name, test in vars(base).get("_left_out", {}).items():
                setattr(cls, name, test)
        cls._left_out = {}
        for name in dir(cls):
            test = getattr(cls, name)
            needs = getattr(test, "needs", None)
            if needs is not None and not any(needs(subject) for subject in subjects):
                cls._left_out[name] = test
                setattr(cls, name, None)

    @classmethod
    def subjects(cls) -> list[Subject]:
        """Return the laws to test.

        Raises
        ------
        TypeError
            When there is none, or one is no law.
        """
        given = list(cls.laws) or [cls.law]
        if given == [None]:
            raise TypeError(f"{cls.__name__} tests no law: write `law = ...` in the class")
        return [Subject.of(law, cls) for law in given]

    @classmethod
    def owners(cls) -> list[Any]:
        """Return the laws that have a field list."""
        return [s.core for s in cls.subjects() if s.core is not None]

    def pytest_generate_tests(self, metafunc: pytest.Metafunc) -> None:
        """Run a test once for each law it can be asked of."""
        if "subject" in metafunc.fixturenames:
            needs = getattr(metafunc.function, "needs", None)
            chosen = [s for s in self.subjects() if needs is None or needs(s)]
            metafunc.parametrize("subject", chosen, ids=[s.name for s in chosen])
        super().pytest_generate_tests(metafunc)
