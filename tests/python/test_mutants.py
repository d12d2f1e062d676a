"""Every bug of tests/mutants still changes one line; whether tests notice them is asked by hand, by its run.py."""

import importlib.util
import sys
from pathlib import Path

MUTANTS = Path(__file__).parents[1] / "mutants" / "run.py"


def test_every_mutant_applies_and_has_its_tests() -> None:
    spec = importlib.util.spec_from_file_location("mutants_run", MUTANTS)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclasses look their module up
    spec.loader.exec_module(module)
    found = module.mutants()
    assert len(found) >= 55
    assert len({one.name for one in found}) == len(found)
    root = MUTANTS.parents[2]
    for one in found:
        one.text()  # raises
        kind = "cpp/{}_test.cpp" if one.file.endswith(".hpp") else "python/{}.py"
        assert one.tests
        for test in one.tests:
            assert (root / "tests" / kind.format(test)).is_file(), test
