"""Fault injection: every kind passes, the same seed gives the same, and what it counts adds up."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from ebac import _core, faults
from ebac.cli import app

KINDS = len(faults.kinds())
CASES = KINDS * 20


@pytest.mark.slow
def test_every_case_passes_and_every_kind_is_there() -> None:
    found = faults.run_campaign(CASES, seed=11)
    assert found.passed == CASES, [row.row() for row in found.rows if row.failures]
    assert [row.kind for row in found.rows] == list(faults.kinds())
    assert sum(row.cases for row in found.rows) == CASES
    never = {"late_answer", "duplicate_answer", "encoder_wrap", "parameter_writes", "stop"}
    never |= {"destroyed_frames", "force_at_start", "force_swings", "force_held", "workspace_edge"}
    never |= {"late_drive", "unheeded_fault", "pause", "nan_joint"}
    for row in found.rows:
        assert (row.found == 0) == (row.kind in never), row.kind
        assert row.worst_ticks_to_zero <= 2


def test_a_seed_gives_the_same_on_any_number_of_threads() -> None:
    one = faults.run_campaign(92, seed=5, threads=1)
    assert one == faults.run_campaign(92, seed=5, threads=3)
    assert one != faults.run_campaign(92, seed=6, threads=1)


@pytest.mark.parametrize("kind", ["silent_node", "nan_law", "encoder_jump", "overruns"])
def test_a_case_describes_itself(kind: str) -> None:
    index = list(faults.kinds()).index(kind)
    indices = range(index, KINDS * 12, KINDS)
    cases = [faults.run_case(i, seed=2) for i in indices]
    stopped = [case for case in cases if case.trace["fault"].any()]
    assert stopped
    assert {(case.verdict, case.breach) for case in cases} == {("passed", None)}
    for case in stopped:
        trace = case.trace
        row = int((trace["fault"] != 0).argmax())
        assert row >= case.at
        assert (trace["current"][row:] == 0).all()
        assert set(np.unique(trace["state"][:row])) == {
            int(_core.LoopState.ARM),
            int(_core.LoopState.RUN),
        }
        assert (trace["state"][row:] == int(_core.LoopState.STOP)).all()
        assert (np.diff((trace["fault"] != 0).astype(int)) >= 0).all(), "it latches"


@pytest.mark.slow
def test_every_fault_of_the_table_can_be_made() -> None:
    """But for a device that is another; nor does any injected fault starve the law's account (test_ledger.py)."""
    seen = {int(faults.run_case(i, seed=4).trace["fault"].max()) for i in range(KINDS * 10)}
    every = {int(fault) for fault in _core.Fault} - {0}
    assert sorted(_core.Fault(number).name for number in every - seen) == [
        "MOTION_IMPLAUSIBLE",
        "POSITION_NOT_FINITE",
        "STARVED",
    ]


def test_bad_numbers_are_refused() -> None:
    with pytest.raises(ValueError, match=r"cases = 0: must lie in \[1, 10000000\]"):
        faults.run_campaign(0)
    with pytest.raises(ValueError, match="seed = -1"):
        faults.run_campaign(1, seed=-1)
    with pytest.raises(ValueError, match=r"threads = 0: must lie in \[1, 1024\]; without it"):
        faults.run_campaign(1, threads=0)
    with pytest.raises(ValueError, match="index = -1"):
        faults.run_case(-1)


def test_the_command_prints_its_document() -> None:
    ran = CliRunner().invoke(app, ["faults", "--cases", "46", "--seed", "3", "--json"])
    assert ran.exit_code == 0, ran.output
    found = json.loads(ran.stdout)
    assert found["cases"] == found["passed"] == 46
    keys = {"kind", "what", "count", "found", "worst_ticks_to_zero", "worst_ticks_to_off"}
    assert {*keys, "failures", "reasons", "first_failure", "first_breach"} == set(found["rows"][0])


@pytest.mark.slow
def test_the_command_draws_the_cases_a_person_wants_to_see(tmp_path) -> None:  # type: ignore[no-untyped-def]
    out = tmp_path / "campaign"
    ran = CliRunner().invoke(app, ["faults", "--cases", str(KINDS), "--out", str(out)])
    assert ran.exit_code == 0, ran.output
    assert f"{KINDS} of {KINDS} cases passed" in ran.output
    assert {path.name.split("-")[0] for path in out.glob("*.png")} >= {"silent_node", "stop"}
