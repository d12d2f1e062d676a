"""Fig. 11: TCA, EBA and EBAC against a virtual wall of 10 kN/m."""

from __future__ import annotations

from ebac import wording
from ebac.metrics import Contact, contact
from ebac.paper.finding import Finding, Row, judge, row
from ebac.scenario import Scenario
from ebac.simulation import simulate

LAWS = ("tca", "eba", "ebac-printed", "ebac")
#: Oscillations from here on are huge [m], and a deviation from here on is one [m].
HUGE = 5e-3
DEVIATES = 1e-3


def fig11() -> Finding:
    """Check Fig. 11: which law swings, which deviates, which does neither."""
    from ebac.plot import plot_walls

    scenario = Scenario()
    traces = [simulate(scenario, law) for law in LAWS]
    found = {trace.law: contact(trace) for trace in traces}
    swings = found["tca"].swing_m >= HUGE
    deviates = found["eba"].quiet and abs(found["eba"].deviation_m or 0) > DEVIATES
    exact, printed = (
        found[law].quiet and bool(found[law].exact) for law in ("ebac", "ebac-printed")
    )
    return Finding(
        name="fig11",
        title="Fig. 11: three laws against a virtual wall of 10 kN/m",
        claim="TCA has huge oscillations; EBA is stable but deviates; the position of EBAC has no "
        "steady-state deviation, and its force stabilizes quickly.",
        rows=[one for law in LAWS for one in _rows(found[law])],
        verdict=judge(swings, deviates, exact, printed),
        why=_why(found, swings, deviates, exact, printed),
        figure=plot_walls(traces),
    )


def _rows(measured: Contact) -> list[Row]:
    law = measured.law
    return [
        row(f"{law}: rest", measured.rest_m, "m"),
        row(f"{law}: beyond the ideal", measured.deviation_m, "m"),
        row(f"{law}: swing", measured.swing_m, "m"),
        row(f"{law}: force swing", measured.force_swing_N, "N"),
        row(f"{law}: settled", measured.settled_s, "s"),
        row(f"{law}: least port energy", measured.least_energy_J, "J"),
    ]


def _why(
    found: dict[str, Contact], swings: bool, deviates: bool, exact: bool, printed: bool
) -> str:
    """Tell each claim and whether it holds."""

    def holds(claim: bool) -> str:
        return "reproduced" if claim else "not reproduced"

    def off(law: str) -> str:
        return wording.quantity(found[law].deviation_m, "m", signed=True)

    return (
        f"TCA has huge oscillations: {holds(swings)} "
        f"({wording.quantity(found['tca'].swing_m, 'm')} peak to peak). "
        f"EBA is stable but deviates: {holds(deviates)} ({off('eba')}). "
        f"EBAC has no steady-state deviation: {holds(exact)} by the completed law ({off('ebac')}); "
        f"{holds(printed)} by eq. (8) to (10) as printed ({off('ebac-printed')}). "
        "The paper gives no numbers, and neither hand nor device of its figure; this is a "
        "simulation of the reference scenario, not a measurement."
    )
