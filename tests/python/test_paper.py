"""The paper's items: numbers, verdicts and the report."""

import json
from functools import cache
from pathlib import Path

import pytest

from ebac import paper
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
    assert found["peak force"] == pytest.approx(42.4)
    assert found["travel, chord"] == pytest.approx(0.1)
    assert found["travel, arc"] == pytest.approx(0.1047, abs=5e-5)
    assert find("specs").verdict == "reproduced in part"
    assert "diameter of the sphere" in find("specs").why


def test_fig5_completed_law_holds_from_contact_and_from_free_air() -> None:
    found = values("fig5")
    completed = [v for q, v in found.items() if q.startswith("completed") and "ideal" in q]
    printed = [v for q, v in found.items() if q.startswith("as printed") and "ideal" in q]
    assert len(completed) == len(printed) == 3
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


def test_workspace() -> None:
    assert find("fig6").verdict == "reproduced"
    assert find("fig7").verdict == "not reproduced"
    assert values("fig7")["reach along x, chord"] == pytest.approx(0.1)
    assert values("fig7")["diameter of the sphere"] == pytest.approx(0.2)


def test_fig11_tells_each_claim() -> None:
    finding = find("fig11")
    assert finding.verdict == "reproduced in part"
    assert "TCA has huge oscillations: reproduced" in finding.why
    assert "EBA is stable but deviates: reproduced" in finding.why
    assert "reproduced by the completed law" in finding.why
    assert "not reproduced by eq. (8) to (10) as printed" in finding.why
    assert "simulation" in finding.why


def test_an_unknown_item_is_refused() -> None:
    with pytest.raises(KeyError, match="fig11"):
        paper.find("fig8")


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


def test_report_writes_all(tmp_path: Path) -> None:
    findings = [find(name) for name in paper.ITEMS]
    files = paper.report(tmp_path / "report", findings)
    names = {file.name for file in files}
    assert names == {"report.md", "report.json", "fig5.png", "fig6.png", "fig7.png", "fig11.png"}
    assert {file.name for file in (tmp_path / "report").iterdir()} == names
    answer = json.loads((tmp_path / "report" / "report.json").read_text())
    assert [item["verdict"] for item in answer["rows"]] == [f.verdict for f in findings]
    page = (tmp_path / "report" / "report.md").read_text()
    assert all(f"Verdict: {finding.verdict}." in page for finding in findings)
    assert "| continuous force | 10.60 N | 10.60 N | 0 N |" in page


def test_report_writes_nothing_when_it_fails(tmp_path: Path) -> None:
    with pytest.raises(KeyError, match="fig8"):
        paper.report(tmp_path / "report", ["eq1", "fig8"])
    assert list(tmp_path.iterdir()) == []
