"""Every bug of tests/mutants still changes one line; whether tests notice them is asked by hand, by its run.py."""

import importlib.util
import json
import sys
from collections.abc import Generator
from pathlib import Path
from types import ModuleType

import pytest

MUTANTS = Path(__file__).parents[1] / "mutants" / "run.py"


@pytest.fixture(scope="module")
def mutants() -> ModuleType:
    spec = importlib.util.spec_from_file_location("mutants_run", MUTANTS)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclasses look their module up
    spec.loader.exec_module(module)
    return module


def test_every_mutant_applies_and_has_its_tests(mutants: ModuleType) -> None:
    found = mutants.mutants()
    assert len(found) >= 55
    assert len({one.name for one in found}) == len(found)
    root = MUTANTS.parents[2]
    for one in found:
        one.text()  # raises
        kind = "cpp/{}_test.cpp" if one.file.endswith("pp") else "python/{}.py"
        assert one.tests
        for test in one.tests:
            assert (root / "tests" / kind.format(test)).is_file(), test


def test_ctrl_c_leaves_the_verdicts_so_far(
    mutants: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def judged(*_: object) -> Generator[object, None, None]:
        yield mutants.Found(name="no limits", tests=True, campaign=False)
        raise KeyboardInterrupt

    monkeypatch.setattr(mutants, "judged", judged)
    monkeypatch.setattr(sys, "argv", ["run.py", "--json"])
    assert mutants.main() == 130
    out, err = capsys.readouterr()
    assert json.loads(out)["score"] == {"tests": [1, 1], "campaign": [0, 1]}
    assert f"1 of {len(mutants.mutants())}: no limits: noticed by the tests, NOT noticed" in err
    assert "stopped after 1 of" in err
