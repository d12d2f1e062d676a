"""A law gives finite numbers within its declared limits, and none without contact."""

from __future__ import annotations

import math

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from ebac._core import Port, Timing
from ebac.testing import strategies
from ebac.testing.contract.subject import Subject, of_core, random_ports

#: A test of the kit is inherited by many classes, and a law in Python is slow. It has the same cases in every run,
#: unless someone loaded a profile of hypothesis: then that decides.
inherited = settings(
    settings(derandomize=True, database=None)
    if settings.default == settings.get_profile("default")
    else None,
    deadline=None,
    suppress_health_check=[HealthCheck.differing_executors, HealthCheck.too_slow],
)

#: Four ticks into a wall: what follows with a lag or at a limited rate needs more than one tick to let go.
CONTACT = [Port(x=5e-4 * k, dx=5e-4, v=0.5, dt=1e-3, f_env=500.0 * k) for k in range(1, 5)]


class Numbers:
    """Finite in is finite out; no force at rest in free air."""

    @inherited
    @given(
        ports=st.lists(strategies.ports(extreme=True), min_size=1, max_size=30),
        delay=st.integers(0, 2),
    )
    def test_finite_in_is_finite_out_and_within_the_peak(
        self, subject: Subject, ports: list[Port], delay: int
    ) -> None:
        law = subject.made(Timing(delay=delay))
        peak = getattr(law, "peak_force", math.inf)
        for port in ports:
            force = law.step(port)
            assert math.isfinite(force), f"{force} N for {port}"
            assert abs(force) <= peak

    @of_core
    @pytest.mark.parametrize("start", [-0.02, 0.0])
    def test_the_state_of_a_law_stays_finite(self, subject: Subject, start: float) -> None:
        """From free air too. Only a slope dF/dx may be undefined, which is NaN."""
        law = subject.made()
        ports = random_ports(7, 1000, start, drift=2)
        assert ports[-1].x > 0
        for port in ports:
            law.step(port)
            for column, value in law.state.as_dict().items():
                assert math.isfinite(value) or column.startswith("beta"), column

    @inherited
    @given(before=st.lists(strategies.ports(), max_size=20), x=st.floats(-0.1, -1e-6))
    @example(before=CONTACT, x=-1e-3)
    def test_at_rest_and_out_of_contact_there_is_no_force(
        self, subject: Subject, before: list[Port], x: float
    ) -> None:
        law = subject.made()
        for port in [] if subject.contract.holds_force else before:
            law.step(port)
        law.step(Port(x=x, dt=1e-3))
        for _ in range(3):
            force = law.step(Port(x=x, dt=1e-3))
            assert force == 0, (
                f"{force:g} N at rest in free air, at {1e3 * x:g} mm; a law that may keep a force there has "
                "holds_force = True in its LawContract"
            )
