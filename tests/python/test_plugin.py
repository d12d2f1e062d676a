"""The pytest plugin as a user has it: in an empty project, with one law, one golden trace, and a flag."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import ebac

WALL = """
    import ebac

    def test_wall(ebac_trace):
        scenario = ebac.Scenario(seconds=0.3, hand=ebac.Hand(stiffness={stiffness}))
        ebac_trace.check(ebac.simulate(scenario, "eba"))
"""


@pytest.fixture
def project(pytester: pytest.Pytester) -> pytest.Pytester:
    pytester.makeini("[pytest]\naddopts = --strict-markers --strict-config -p no:cacheprovider")
    return pytester


def wall(project: pytest.Pytester, stiffness: float) -> Path:
    project.makepyfile(test_mine=WALL.format(stiffness=stiffness))
    return project.path / "test_mine"


def told(result: pytest.RunResult) -> str:
    return str(result.stdout.str())


# --- golden traces ---


def test_the_first_run_writes_and_fails_the_second_passes(project: pytest.Pytester) -> None:
    folder = wall(project, 300)
    first = project.runpytest_inprocess()
    first.assert_outcomes(failed=1)
    assert "there was no golden trace: written to" in told(first)
    assert {f.name for f in folder.iterdir()} == {"test_wall.npz", "test_wall.json"}
    assert len(ebac.Trace.from_npz(folder / "test_wall.npz")) == 301
    project.runpytest_inprocess().assert_outcomes(passed=1)


@pytest.mark.parametrize("text", ["<<<<<<< HEAD\n{", "{}", "[]", "3"])
def test_golden_metrics_that_are_none_are_refused(project: pytest.Pytester, text: str) -> None:
    """Empty ones passed without a comparison, and the marks of a merge were an error without the file's name."""
    folder = wall(project, 300)
    project.runpytest_inprocess()
    (folder / "test_wall.json").write_text(text, encoding="utf-8")
    result = project.runpytest_inprocess()
    result.assert_outcomes(failed=1)
    assert "test_wall.json: holds no golden metrics; if it is meant to differ: pytest" in told(
        result
    )


@pytest.mark.slow
def test_a_difference_is_named_drawn_and_updated_by_the_flag(project: pytest.Pytester) -> None:
    folder = wall(project, 300)
    project.runpytest_inprocess()
    before = (folder / "test_wall.npz").read_bytes()
    golden = ebac.Trace.from_npz(folder / "test_wall.npz")
    wall(project, 350)
    result = project.runpytest_inprocess(f"--basetemp={project.path / 'tmp'}")
    result.assert_outcomes(failed=1)
    scenario = ebac.Scenario(seconds=0.3, hand=ebac.Hand(stiffness=350))
    trace = ebac.simulate(scenario, "eba")
    off = np.abs(trace["f_cmd"] - golden["f_cmd"])
    tick = int((off > 1e-5 + 1e-6 * np.abs(golden["f_cmd"])).argmax())
    text = told(result)
    assert f"f_cmd: first at tick {tick}, t = {tick / 1000:.6g} s: " in text
    assert f"largest error {off.max():.9g} N at tick {off.argmax()}" in text
    assert "first divergence: " in text
    assert "metric peak_m: " in text
    assert ": worse by +" in text
    overlay = project.path / "tmp" / "test_wall0" / "test_wall.png"
    assert f"overlay: {overlay}" in text
    assert overlay.read_bytes().startswith(b"\x89PNG")
    assert (folder / "test_wall.npz").read_bytes() == before

    project.runpytest_inprocess("--ebac-update").assert_outcomes(passed=1)
    assert (folder / "test_wall.npz").read_bytes() != before
    project.runpytest_inprocess().assert_outcomes(passed=1)


@pytest.mark.slow
def test_only_what_is_missing_is_written_without_the_flag(project: pytest.Pytester) -> None:
    folder = wall(project, 300)
    project.runpytest_inprocess()
    before = (folder / "test_wall.npz").read_bytes()
    (folder / "test_wall.json").unlink()
    wall(project, 350)
    first = project.runpytest_inprocess()
    first.assert_outcomes(failed=1)
    assert f"no file of golden metrics: written to {folder / 'test_wall.json'}; look at" in told(
        first
    )
    assert (folder / "test_wall.npz").read_bytes() == before
    project.runpytest_inprocess().assert_outcomes(failed=1)


@pytest.mark.slow
@pytest.mark.weekly
def test_tests_in_parallel_write_and_compare_their_own(project: pytest.Pytester) -> None:
    pytest.importorskip("xdist")
    project.makepyfile(
        test_mine="""
        import ebac, pytest

        @pytest.mark.parametrize("law", ["tca", "eba"])
        class TestWall:
            def test_wall(self, law, ebac_trace):
                ebac_trace.check(ebac.simulate(ebac.Scenario(seconds=0.2), law))
        """
    )
    project.runpytest_subprocess("-n", "2", "--ebac-update").assert_outcomes(passed=2)
    files = {f.stem for f in (project.path / "test_mine").iterdir()}
    laws = ("tca", "eba")
    assert files == {f"TestWall.test_wall_{law}" for law in laws}  # and no draft is left
    project.runpytest_subprocess("-n", "2").assert_outcomes(passed=2)


def test_two_tests_do_not_share_a_golden_trace(project: pytest.Pytester) -> None:
    project.makepyfile(
        test_mine="""
        import ebac, pytest

        @pytest.mark.parametrize("law", ["tca", "eba"], ids=["a b", "a,b"])
        def test_wall(law, ebac_trace):
            ebac_trace.check(ebac.simulate(ebac.Scenario(seconds=0.2), law))
        """
    )
    found = project.runpytest_inprocess("--ebac-update")
    found.assert_outcomes(errors=2)
    assert "test_wall[a b] have the same golden trace" in told(found)
    assert not (project.path / "test_mine").exists()


def test_a_folder_of_all_golden_traces_can_be_named(project: pytest.Pytester) -> None:
    project.makeini("[pytest]\nebac_golden = tests/golden")
    wall(project, 300)
    project.runpytest_inprocess("--ebac-update").assert_outcomes(passed=1)
    assert (project.path / "tests" / "golden" / "test_wall.npz").exists()


WRONG = [
    ("columns=['x', 'nonsense']", "no column is called 'nonsense'; there are: "),
    ("columns='f_env'", "columns = 'f_env': must be a sequence, such as ['f_env']"),
    ("untl=0.05", "TraceRegression.check has no parameter 'untl', did you mean 'until'; it has"),
    ("every=0", "every = 0: must be at least 1"),
    ("every=2.5", "every = 2.5: must be a whole number"),
    ("until=float('nan')", "stop = nan s: must be a time"),
    (
        "until=50",
        "until = 50 s: must be at most 0.1 s, where the run ends: leave it out for all rows; 50 ms are",
    ),
    ("until=0.2", "until = 0.2 s: must be at most 0.1 s, where the run ends: leave it out"),
    ("tolerances={'x': 1e-3}", "tolerance for x takes a Tolerance, as in Tolerance(absolute="),
    ("tolerances={'x': Tolerance(absolute='a')}", "Tolerance.absolute = 'a': must be a number"),
    ("metric_tolerances={'swing_m': 'a'}", "tolerance of swing_m = 'a': must be a number"),
    ("metric_tolerances={'swing': 1}", "metric 'swing': there are rest_m, "),
    ("tolerances={'v': Tolerance(absolute=-1)}", "Tolerance.absolute = -1: must be finite"),
    ("columns=['x'], tolerances={'q': Tolerance()}", "tolerance for q: compared are only t, x"),
]


def test_what_cannot_be_asked_is_refused(project: pytest.Pytester) -> None:
    begin = "import ebac\nfrom ebac.testing import Tolerance\n"
    begin += 'trace = ebac.simulate(ebac.Scenario(seconds=0.1), "tca")\n'
    checks = [f"ebac_trace.check(trace, {how})" for how, _ in WRONG]
    tests = [f"def test_{k}(ebac_trace): {check}\n" for k, check in enumerate(checks)]
    project.makepyfile(begin + "".join(tests))
    for words in ([], ["--ebac-update"]):
        failed = project.inline_run(*words).getfailures("pytest_runtest_logreport")
        for (how, message), one in zip(WRONG, failed, strict=True):
            assert message in one.longreprtext, how
    assert not list(project.path.rglob("*.npz"))  # nor is a golden trace written


def test_a_run_of_another_length_is_no_match(project: pytest.Pytester) -> None:
    wall(project, 300)
    project.runpytest_inprocess()
    project.makepyfile(test_mine=WALL.format(stiffness=300).replace("0.3", "0.2"))
    result = project.runpytest_inprocess()
    result.assert_outcomes(failed=1)
    assert "the trace has 201 rows from 0 to 0.2 s on 1 axis, the golden one 301 rows" in told(
        result
    )


def test_the_plugin_costs_nothing_until_it_is_used() -> None:
    code = "import pytest_ebac, sys; print([m for m in ('numpy', 'ebac', 'hypothesis') if m in sys.modules])"
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert run.stdout.strip() == "[]"


# --- the contract on a law of a user's own ---

LAWS = """
    import ebac
    from ebac.testing import LawContract

    class Damped:
        def reset(self):
            pass

        def step(self, port):
            return port.f_env + 20 * port.v if port.f_env > 0 else 0.0

    class Remembers(Damped):
        last = 0.0

        def step(self, port):
            self.last = 0.5 * self.last + super().step(port) if port.f_env > 0 else 0.0
            return self.last

    class Bounded:
        passive = True

        def __init__(self, facts, timing, share):
            self.inner, self.share = ebac.EBAAccount.design(facts, timing), share

        @classmethod
        def design(cls, facts, timing):
            return cls(facts, timing, 1.0)

        def reset(self):
            self.inner.reset()

        def step(self, port):
            return self.share * self.inner.step(port)

        def __deepcopy__(self, memo):
            twin = object.__new__(type(self))
            twin.inner, twin.share = self.inner.copy(), self.share
            return twin

    class Active(Bounded):
        @classmethod
        def design(cls, facts, timing):
            return cls(facts, timing, 1.05)
"""


def conformance(project: pytest.Pytester, law: str) -> pytest.RunResult:
    project.makeconftest(
        "from hypothesis import settings\n"
        "settings.register_profile('quick', max_examples=10, derandomize=True, database=None)\n"
        "settings.load_profile('quick')"
    )
    project.makepyfile(test_law=f"{LAWS}\n    class TestMine(LawContract):\n        law = {law}\n")
    return project.runpytest_inprocess("-q", "-ra")


@pytest.mark.slow
@pytest.mark.parametrize("law", ["lambda: Damped()", "Bounded"])
def test_a_good_law_in_python_keeps_the_contract(project: pytest.Pytester, law: str) -> None:
    result = conformance(project, law)
    outcomes = result.parseoutcomes()
    assert set(outcomes) == {"passed"}
    assert outcomes["passed"] == (22 if law == "Bounded" else 11)


def test_the_example_runs_the_contract_on_its_law(project: pytest.Pytester) -> None:
    example = Path(__file__).parents[2] / "examples" / "02_law_in_python.py"
    result = project.runpytest_inprocess("--import-mode=importlib", str(example))
    result.assert_outcomes(passed=11)


def test_a_law_that_keeps_something_over_a_reset_is_caught(project: pytest.Pytester) -> None:
    result = conformance(project, "Remembers")
    assert "after reset() it acts otherwise than fresh" in told(result)
    result.stdout.fnmatch_lines(["FAILED *test_reset_forgets_everything*"])


def test_a_subtly_active_law_is_caught(project: pytest.Pytester) -> None:
    """One that gives 5 % more force than the energy-bounding algorithm allows."""
    result = conformance(project, "Active")
    result.stdout.fnmatch_lines(["FAILED *test_a_passive_law_keeps_its_bound_in_any_world*"])
    assert "Active is declared passive and gave out" in told(result)


def test_what_is_no_law_is_refused_when_the_class_is_made(project: pytest.Pytester) -> None:
    result = conformance(project, "3.0")
    assert "3.0 (float) is no law: it needs step(port) -> float and reset()" in told(result)


WATCHED = """
    from pathlib import Path
    from ebac.testing import LawContract

    class Watched:
        def reset(self):
            pass

        def step(self, port):
            with Path("seen.txt").open("a") as seen:
                print(port, file=seen)
            return port.f_env

    class TestMine(LawContract):
        law = Watched
"""


def test_the_cases_of_a_contract_are_the_same_in_every_run(project: pytest.Pytester) -> None:
    """One law passed, and failed after hypothesis had kept an example. In CI hypothesis has a profile of its own."""
    project.makepyfile(test_law=WATCHED)
    runs = []
    for _ in range(2):
        (project.path / "seen.txt").unlink(missing_ok=True)
        chosen = ("-k", "at_rest", "--hypothesis-profile=default")
        project.runpytest_subprocess(*chosen).assert_outcomes(passed=1)
        runs.append((project.path / "seen.txt").read_text())
    assert runs[0] == runs[1]


def test_a_profile_that_someone_loads_holds_for_the_contract_and_is_left_as_it_is() -> None:
    code = """if True:
        from hypothesis import settings
        settings.register_profile("mine", derandomize=False, max_examples=7)
        settings.load_profile("mine")
        from ebac.testing.contract.numbers import inherited
        print(inherited.derandomize, inherited.max_examples, settings.default == settings.get_profile("mine"))
    """
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert run.stdout.split() == ["False", "7", "True"]


# --- what a failed test shows ---


def test_a_fault_shows_the_line_of_the_test_and_no_code_of_the_library(
    project: pytest.Pytester,
) -> None:
    """A NaN of a law took 130 lines, most of them the docstring of `simulate`."""
    project.makepyfile(
        test_mine="""
        import math
        import ebac

        class Mine:
            name = "mine"

            def reset(self):
                pass

            def step(self, port):
                return math.nan

        def test_nan():
            ebac.simulate(ebac.Scenario(seconds=0.1), Mine())
        """
    )
    result = project.runpytest_inprocess()
    result.assert_outcomes(failed=1)
    text = told(result)
    assert ">       ebac.simulate(ebac.Scenario(seconds=0.1), Mine())" in text
    assert "mine gave no finite force) in tick 0" in text
    assert "simulation.py" not in text
    assert text.count("\n") < 30
