"""The contract of every law, run on those of this folder: `pytest test_damped.py`."""

from my_laws import Damped, Tank

from ebac.testing import LawContract


class TestDamped(LawContract):
    law = Damped


class TestTank(LawContract):
    law = Tank
