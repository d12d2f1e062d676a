"""The contract of every law, run on the one of this folder: `pytest test_damped.py`."""

from my_laws import Damped

from ebac.testing import LawContract


class TestDamped(LawContract):
    law = Damped
