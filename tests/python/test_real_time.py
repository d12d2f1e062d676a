"""A test of the clock that fails is repeated alone, where the machine stalled its loop more often."""

from pathlib import Path

import pytest
from busy_machine import LATE

CONFTEST = Path(__file__).with_name("conftest.py")

TEST = """
    import pytest

    failed = {}

    @pytest.fixture
    def room():
        yield []

    def fail(name, room, times, message):
        room.append(1)
        assert len(room) == 1, "the fixture of before"
        failed[name] = failed.get(name, 0) + 1
        assert failed[name] > times, message

    @pytest.mark.real_time
    @pytest.mark.parametrize(("times", "message"), [
        (0, "fault 16 (force stale)"),
        (2, "fault 16 (force stale) in tick 7"),
        (1, "fault 19 (overruns)"),
        (8, "fault 9 (drive silent)"),
        (1, "30 ticks could not be kept and were skipped. Error: fault 21 (starved)"),
        (1, "fault 21 (starved)"),
        (1, "fault 15 (workspace)"),
        (2, "wrong"),
        (3, "wrong thrice"),
    ])
    def test_marked(room, times, message):
        fail(message, room, times, message)

    def test_bare(room):
        fail("bare", room, 1, "fault 16 (force stale)")
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    "more",
    [
        pytest.param((), id="here"),
        pytest.param(("-n", "1"), id="in a worker", marks=pytest.mark.weekly),
    ],
)
def test_a_stall_is_repeated_more_often_and_what_is_not_of_the_clock_never(
    pytester: pytest.Pytester, more: tuple[str, ...]
) -> None:
    if more:
        pytest.importorskip("xdist")
    pytester.makeconftest(CONFTEST.read_text(encoding="utf-8"))
    pytester.makeini(f"[pytest]\npythonpath = {CONFTEST.parents[1] / 'pages'}\n")
    pytester.makepyfile(test_mine=TEST)
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider", *more)
    result.assert_outcomes(passed=7, failed=3)
    said = [line for line in result.outlines if line.startswith("repeated alone: ")]
    assert [line.count(", ", line.index("]")) + 1 for line in sorted(said)] == [
        1,
        1,
        1,
        1,
        2,
        2,
        2,
        7,
    ]


ALONE = """
    import time
    from pathlib import Path

    import pytest

    tried = []

    def others(tmp_path_factory):
        return tmp_path_factory.getbasetemp().parent.glob("running-*")

    @pytest.mark.real_time
    def test_of_the_clock(tmp_path_factory):
        tried.append(1)
        for _ in range(20):
            if list(others(tmp_path_factory)):
                pytest.fail("fault 19 (overruns)" if len(tried) == 1 else "not alone")
            time.sleep(0.01)
        assert len(tried) > 1, "fault 19 (overruns)"

    @pytest.mark.parametrize("number", range(20))
    def test_other(tmp_path_factory, number):
        mark = tmp_path_factory.getbasetemp().parent / f"running-{number}"
        mark.touch()
        time.sleep(0.05)
        mark.unlink()
"""


@pytest.mark.slow
@pytest.mark.weekly
def test_what_is_repeated_is_repeated_alone(pytester: pytest.Pytester) -> None:
    pytest.importorskip("xdist")
    pytester.makeconftest(CONFTEST.read_text(encoding="utf-8"))
    pytester.makeini(f"[pytest]\npythonpath = {CONFTEST.parents[1] / 'pages'}\n")
    pytester.makepyfile(test_mine=ALONE)
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider", "-n", "2")
    result.assert_outcomes(passed=21)


def test_the_words_are_those_of_a_fault() -> None:
    import ebac

    names = {9: "drive silent", 11: "heartbeat lost", 16: "force stale", 19: "overruns"}
    text = LATE.pattern
    for number, name in names.items():
        fault = ebac.Fault(number)
        assert fault.name.lower().replace("_", " ") == name
        assert name in text
