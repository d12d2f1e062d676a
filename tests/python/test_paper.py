"""The paper's items: numbers, verdicts and the report."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ebac
from ebac import paper
from ebac.paper.fig11 import force_settled
from ebac.paper.finding import judge, row

find = cache(paper.find)


def values(name: str) -> dict[str, float]:
    return {
        str(line["quantity"]): line["value"]
        for line in find(name).rows
        if isinstance(line["value"], (int, float))
    }


def test_eq1_gives_the_papers_current() -> None:
    finding = find("eq1")
    assert finding.verdict == "reproduced"
    currents = [
        value for quantity, value in values("eq1").items() if quantity.startswith("current")
    ]
    assert currents == pytest.approx([0.4926, 0.4926], abs=5e-5)


def test_specs_agree_but_for_the_workspace() -> None:
    found = values("specs")
    assert found["resolution"] == pytest.approx(0.0307e-3, abs=5e-8)
    assert found["continuous force"] == pytest.approx(10.6)
    assert found["peak force, an input"] == pytest.approx(42.4)
    paper_has = {str(line["quantity"]): line["paper"] for line in find("specs").rows}
    assert paper_has["peak force, an input"] is None  # chosen from the paper's own number
    assert found["force of the motor's stall current"] > 1.5 * found["peak force, an input"]
    assert found["travel, chord"] == pytest.approx(0.1)
    assert found["travel, arc"] == pytest.approx(0.1047, abs=5e-5)
    assert find("specs").verdict == "reproduced in part"
    assert "diameter of the sphere" in find("specs").why


def test_fig5_completed_law_holds_from_contact_and_from_free_air() -> None:
    found = values("fig5")
    completed = [v for q, v in found.items() if q.startswith("completed") and "ideal" in q]
    printed = [v for q, v in found.items() if q.startswith("as printed") and "ideal" in q]
    assert (len(completed), len(printed)) == (3, 6)  # printed: with its force loop, and K_p = 0
    assert max(map(abs, completed)) < 0.062e-3
    assert min(printed) > 1e-3
    assert find("fig5").verdict == "reproduced in part"


def test_fig5_printed_law_stays_silent_in_soft_contact() -> None:
    (silent,) = [
        value
        for quantity, value in values("fig5").items()
        if quantity.startswith("as printed, 100 N/m") and "zero in contact" in quantity
    ]
    assert silent > 0.01


def test_every_item_of_the_paper_has_a_row() -> None:
    equations = [f"eq{n}" for n in range(1, 13)]
    figures = [f"fig{n}" for n in range(1, 12)]
    assert sorted(paper.ITEMS) == sorted(["specs", "table1", *equations, *figures])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("verdict", "names"),
    [
        ("reproduced", "eq1 eq2 eq5 eq6 eq7 eq8 eq9 fig6"),
        ("reproduced in part", "specs eq3 eq4 eq10 eq12 fig5 fig8 fig9 table1 fig11"),
        ("not reproduced", "fig7"),
        ("nothing to compute", "eq11 fig1 fig2 fig3 fig4 fig10"),
    ],
)
def test_verdicts(verdict: str, names: str) -> None:
    for name in names.split():
        finding = find(name)
        assert (finding.name, finding.verdict) == (name, verdict)
        assert finding.claim
        assert finding.why
        if finding.claims:
            assert judge(*finding.claims) == verdict


def test_equations_agree_to_the_last_digits() -> None:
    assert values("eq2")["largest difference to eq. (2) written out"] < 1e-12
    assert values("eq6")["free motion, largest difference to the closed form"] < 1e-11
    assert values("eq8")["largest difference to eq. (8) over a run"] < 1e-12
    assert values("eq9")["largest F_d - F_e in them"] == 0
    assert values("eq9")["ticks in contact with eq. (9) unlimited"] > 10


@pytest.mark.slow
def test_eq3_holds_for_the_completed_law_within_its_reserve_only() -> None:
    holds = {claim.text.split(":")[0]: claim.holds for claim in find("eq3").claims}
    assert holds == {"eba": False, "eba-account": True, "ebac": True, "ebac-printed": False}
    found = values("eq3")
    assert -found["e(0) that the completed EBAC declares"] <= found[
        "ebac: least energy over 3 x 60 hands"
    ] <= 0  # fmt: skip


def test_eq4_and_eq6_with_one_sign_run_away() -> None:
    assert values("eq4")["fastest root of eq. (4) and (6) as printed"] > 0


def test_eq10_says_what_goes_wrong() -> None:
    assert [claim.holds for claim in find("eq10").claims] == [True, False, False, False, False]


def test_eq12_pulls_as_printed_and_never_here() -> None:
    found = values("eq12")
    assert found["hardest pull of eq. (12), B = 20 N s/m at -1 m/s"] == pytest.approx(20)
    assert found["hardest pull of the library's wall"] == 0


def test_workspace() -> None:
    assert values("fig7")["reach along x, chord"] == pytest.approx(0.1)


def test_fig6_compares_no_input_with_itself() -> None:
    assert all(line["paper"] is None for line in find("fig6").rows)
    assert "inputs" in find("fig6").why
    assert values("fig6")["smallest singular value of the Jacobian"] > 0.06


def test_fig11_judges_each_claim() -> None:
    judged = {claim.text: claim.holds for claim in find("fig11").claims}
    assert judged == {
        "TCA has huge oscillations": True,
        "EBA is stable but deviates": True,
        "EBAC (completed): the position has no steady-state deviation": True,
        "EBAC (as printed): the position has no steady-state deviation": False,
        "EBAC (completed): the force stabilizes quickly": True,
        "EBAC (as printed): the force stabilizes quickly": True,
        "EBAC (as printed, K_p = 0): the position has no steady-state deviation": False,
        "EBAC (as printed, K_p = 0): the force stabilizes quickly": True,
    }
    assert "simulation" in find("fig11").why
    found = values("fig11")
    assert found["ideal wall: short of the hand's target"] > 30e-3  # the other reading
    assert "target of the hand" in find("fig11").why
    for law in ("tca", "eba", "ebac"):
        assert found[f"{law}: short of the hand's target"] == 0.04 - found[f"{law}: rest"]
    assert found["ebac-printed, K_p = 0: beyond the ideal"] > 1e-3
    assert values("fig11")["ebac: force settled"] < 0.05  # s


def test_table1_and_its_figures() -> None:
    own, line, circle = find("table1").claims
    assert own.holds
    assert not line.holds
    assert not circle.holds
    assert find("fig8").figure is not None
    assert find("fig9").figure is not None


@given(level=st.floats(1.0, 40.0), band=st.floats(0.01, 0.2), last=st.integers(1, 600))
def test_a_force_settles_after_its_last_excursion(level: float, band: float, last: int) -> None:
    t = np.arange(1000) * 1e-3
    force = np.full(1000, level)
    force[last] += 2 * band * level
    info = {n: ebac.trace.ColumnInfo(name=n, unit="1", meaning="") for n in ("t", "f_applied")}
    trace = ebac.Trace(data={"t": t, "f_applied": force}, columns=info, axes=1)
    assert force_settled(trace, band) == t[last]


def test_a_force_that_never_settles_has_no_time() -> None:
    assert force_settled(simulate("tca")) is None


def simulate(law: str) -> ebac.Trace:
    return ebac.simulate(ebac.Scenario(seconds=2.0), law)


def test_an_unknown_item_is_refused() -> None:
    with pytest.raises(KeyError, match="fig11"):
        paper.find("fig12")


@pytest.mark.parametrize(
    ("claims", "verdict"),
    [
        ((True, True), "reproduced"),
        ((True, False), "reproduced in part"),
        ((False, False), "not reproduced"),
    ],
)
def test_verdict_follows_from_the_claims(claims: tuple[bool, bool], verdict: str) -> None:
    assert judge(*claims) == verdict


def test_difference_needs_both_numbers() -> None:
    assert row("x", 3.0, "m", 1.0)["difference"] == 2.0
    assert row("x", 3.0, "m")["difference"] is None
    assert row("x", None, "m", 1.0)["difference"] is None


@pytest.mark.slow
@pytest.mark.weekly
def test_report_writes_all(tmp_path: Path) -> None:
    findings = [find(name) for name in paper.ITEMS]
    files = paper.report(tmp_path / "report", findings)
    names = {file.name for file in files}
    drawn = {f"{name}.png" for name in ("fig5", "fig6", "fig7", "fig8", "fig9", "fig11", "table1")}
    assert names == {"report.md", "report.json", *drawn}
    assert {file.name for file in (tmp_path / "report").iterdir()} == names
    answer = json.loads((tmp_path / "report" / "report.json").read_text())
    assert [item["verdict"] for item in answer["rows"]] == [f.verdict for f in findings]
    page = (tmp_path / "report" / "report.md").read_text()
    assert all(f"Verdict: {finding.verdict}." in page for finding in findings)
    assert "| TCA has huge oscillations | reproduced |" in page
    assert "| continuous force | 10.60 N | 10.60 N | 0 N |" in page


def test_report_writes_nothing_when_it_fails(tmp_path: Path) -> None:
    with pytest.raises(KeyError, match="fig12"):
        paper.report(tmp_path / "report", ["eq1", "fig12"])
    assert list(tmp_path.iterdir()) == []
