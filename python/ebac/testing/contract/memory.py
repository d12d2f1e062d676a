"""A law remembers what it should, and nothing after a reset."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import pytest

from ebac.testing.contract.subject import Subject, drive, of_core, random_ports, state_of


def _same(run: list[tuple[str, str]], known: list[tuple[str, str]], wrong: str) -> None:
    """Fail at the first step in which two runs differ."""
    for k, ((force, state), (expected, other)) in enumerate(zip(run, known, strict=True)):
        assert force == expected, f"{wrong}: {force} N instead of {expected} N in step {k}"
        assert state == other, f"{wrong}: its state in step {k}"


class Memory:
    """Reset is total, copies are independent, and the same input gives the same bits."""

    @staticmethod
    def lively(law: Any) -> Any:
        """Return the law with every memory it can have in use; override it for a law with switches of its own."""
        return law.replace(kd=1e-3) if hasattr(law, "kd") and hasattr(law, "_simulate") else law

    def test_the_same_run_twice_gives_the_same_bits(self, subject: Subject) -> None:
        ports = random_ports(1)
        _same(drive(subject.lively(), ports), drive(subject.lively(), ports), "it acts otherwise")

    @pytest.mark.parametrize("start", [0.0, 5e-3], ids=["free", "in contact"])
    def test_reset_forgets_everything(self, subject: Subject, start: float) -> None:
        """What it remembers of a deep contact must not reach a next one, not even one that starts inside the wall."""
        law = subject.lively()
        fresh = drive(law, random_ports(1, start=start))
        drive(law, random_ports(2, drift=2))
        law.reset()
        assert state_of(law) == state_of(subject.lively())
        again = drive(law, random_ports(1, start=start))
        _same(again, fresh, "after reset() it acts otherwise than fresh")

    def test_a_copy_carries_its_state_and_runs_independently(self, subject: Subject) -> None:
        """The loop makes a copy for each axis."""
        ports = random_ports(3)
        whole = drive(subject.lively(), ports)
        law = subject.lively()
        drive(law, ports[:200])
        twin = law.copy() if subject.core else copy.deepcopy(law)
        drive(law, random_ports(4))  # must not reach the copy
        _same(drive(twin, ports[200:]), whole[200:], "the copy acts otherwise")

    @of_core
    @pytest.mark.parametrize(
        "duplicate",
        [copy.copy, copy.deepcopy, lambda law: pickle.loads(pickle.dumps(law))],
        ids=["copy", "deepcopy", "pickle"],
    )
    def test_copying_and_pickling_give_a_fresh_equal_design(
        self, subject: Subject, duplicate: Any
    ) -> None:
        law = subject.lively()
        fresh = drive(law.copy(), random_ports(5))
        drive(law, random_ports(6))
        twin = duplicate(law)
        assert twin is not law
        assert twin == law
        assert hash(twin) == hash(law)
        assert drive(twin, random_ports(5)) == fresh
