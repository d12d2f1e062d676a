"""Run a scenario under a law."""

from __future__ import annotations

from typing import Any

from ebac import _core
from ebac.laws import AnyLaw, CoreLaw, design, law_name
from ebac.scenario import Scenario
from ebac.trace import Trace


class LoopFault(RuntimeError):
    """The loop stopped on a fault. Its force was zero from that tick on.

    Attributes
    ----------
    fault : Fault
        The first fault; it latched.
    trace : Trace
        Every row up to the stop; the last ones are the evidence.
    """

    def __init__(self, fault: _core.Fault, trace: Trace) -> None:
        self.fault = fault
        self.trace = trace
        row = int((trace["fault"] != 0).argmax())
        cause = fault.name.lower().replace("_", " ")
        super().__init__(
            f"fault {int(fault)} ({cause}) in tick {row}, t = {trace['t'][row]:.6g} s: "
            "the command was set to zero and the loop stopped; see .trace for the rows before it"
        )


def simulate(scenario: Scenario, law: AnyLaw = "ebac", **changes: Any) -> Trace:
    """Run a scenario under a law to its end.

    Parameters
    ----------
    scenario : Scenario
        Device, hand, virtual world and time.
    law : str, law class, law or PythonLaw
        A name or class is designed for the scenario's device and timing, jitter included; a law is used as it is.
    **changes
        Parameters to set on top of the design, in their SI units.

    Returns
    -------
    Trace
        One row per tick, `seconds / dt + 1` rows.

    Raises
    ------
    LoopFault
        When a stage gave no finite number; carries the trace.
    KeyError, TypeError, ValueError
        For a law that does not exist or cannot be made; see `design`.
    """
    finished = design(law, scenario.device, scenario.known_timing, **changes)
    setup = scenario.setup()
    if isinstance(finished, CoreLaw):
        rows = finished._simulate(setup)
    else:
        rows = _core._simulate_python(setup, finished)
    trace = Trace.from_rows(
        rows, scenario=scenario, law=law_name(finished), law_repr=repr(finished)
    )
    fault = _core.Fault(int(trace["fault"][-1]))
    if fault is not _core.Fault.NONE:
        raise LoopFault(fault, trace)
    return trace
