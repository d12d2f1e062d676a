"""A law stepped from Python gives the bits of the law in the C++ loop."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import ebac
from ebac.testing.contract.subject import Subject, bits, of_core

WORLDS: dict[str, dict[str, Any]] = {
    "plain": {},
    "jitter and noise": {
        "jitter": 0.3,
        "device": ebac.Device(sensor=ebac.ForceSensor(noise=0.2, quantum=0.05)),
    },
    "friction": {"device": ebac.Device(mechanics=ebac.Mechanics(coulomb=1.0))},
    "two axes": {
        "device": ebac.Device(kinematics=ebac.Linear(axes=2)),
        "environment": ebac.Corner(),
        "hand": ebac.Hand(path=[ebac.Step(), ebac.Sine(frequency=3.0)]),
    },
}
#: All that a law may read of a tick.
READ = ("x", "dx", "v", "dt", "f_env", "f_applied", "f_meas")
ESTIMATED = tuple(field.name for field in ebac.Estimate.fields())


class Agreement:
    """It runs to the end, and its trace holds all that made it act."""

    def test_it_runs_to_the_end_without_a_fault(self, subject: Subject) -> None:
        trace = ebac.simulate(ebac.Scenario(seconds=1.0), subject.made())
        assert len(trace) == 1001
        assert (trace["fault"] == 0).all()

    @of_core
    def test_the_state_of_a_law_is_recorded_in_every_trace(self, subject: Subject) -> None:
        trace = ebac.simulate(ebac.Scenario(seconds=0.1), subject.made())
        core: Any = subject.core
        logged = {f"law.{f.name}": f for f in core.State.fields()}
        assert {column for column in trace if column.startswith("law.")} == set(logged)
        for column, field in logged.items():
            assert trace.columns[column].unit == field.unit
            assert trace.columns[column].meaning == field.meaning

    @of_core
    @pytest.mark.parametrize("delay", [0, 1, 2])
    @pytest.mark.parametrize("world", WORLDS)
    def test_stepping_from_python_equals_the_simulation_to_the_bit(
        self, subject: Subject, delay: int, world: str
    ) -> None:
        scenario = ebac.Scenario(seconds=0.4, timing=ebac.Timing(delay=delay), **WORLDS[world])
        law = subject.made(scenario.timing, scenario.device)
        rows = law._simulate(scenario.setup())
        trace = ebac.Trace.from_rows(rows, scenario=scenario, law=subject.name, law_repr=repr(law))
        for axis in range(trace.axes):
            law.reset()
            for k in range(len(trace)):
                force = law.step(rows.port(k, axis))
                assert bits(force) == bits(trace.axis("f_cmd", axis)[k]), f"force [N] in tick {k}"
                for field in law.state.fields():
                    logged = trace.axis(f"law.{field.name}", axis)[k]
                    known = np.asarray(getattr(law.state, field.name), logged.dtype)
                    assert known.tobytes() == logged.tobytes(), f"{field.name} in tick {k}"

    @pytest.mark.parametrize("world", WORLDS)
    def test_the_columns_of_a_trace_hold_all_that_a_law_reads(
        self, subject: Subject, world: str
    ) -> None:
        scenario = ebac.Scenario(seconds=0.4, **WORLDS[world])
        law = subject.made(scenario.timing, scenario.device)
        trace = ebac.simulate(scenario, law)
        for axis in range(trace.axes):
            law.reset()
            columns = [trace.axis(column, axis).tolist() for column in READ]
            estimates = [trace.axis(f"est.{name}", axis).tolist() for name in ESTIMATED]
            for k, values in enumerate(zip(*columns, strict=True)):
                port = ebac.Port(**dict(zip(READ, values, strict=True)))
                port.est = ebac.Estimate(
                    **{name: column[k] for name, column in zip(ESTIMATED, estimates, strict=True)}
                )
                force = law.step(port)
                assert bits(force) == bits(trace.axis("f_cmd", axis)[k]), f"force [N] in tick {k}"
