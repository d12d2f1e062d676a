"""What the machine can do for a loop. No test asserts a deadline."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from ebac import realtime
from ebac.cli import app
from ebac.realtime.jitter import parse_cyclictest
from ebac.realtime.mode import MODES, mode_named

HISTOGRAM = """# /dev/cpu_dma_latency set to 0us
# Histogram
000000 000000
000001 000010
000002 000080
000003 000009
# Total: 000000099
# Min Latencies: 00001
# Avg Latencies: 00002
# Max Latencies: 07000
# Histogram Overflows: 00001
"""


def test_every_wakeup_is_late_by_at_least_nothing() -> None:
    found = realtime.measure(seconds=0.1, rate=1000, mode="off")
    assert found.grants == []
    assert (found.lateness >= 0).all()
    assert len(found.lateness) + found.skipped >= 100
    row = found.row()
    assert row["p50_s"] <= row["p99_s"] <= row["p99_9_s"] <= row["most_s"]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"seconds": 0}, r"seconds = 0 s: must lie in \(0, 86400\] s"),
        ({"rate": 1}, r"rate = 1 Hz: must lie in \[10, 100000\] Hz"),
        ({"mode": "please"}, "mode = 'please'"),
        ({"seconds": float("nan")}, "seconds = nan s"),
    ],
)
def test_bad_input_is_refused(given: dict[str, float], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        realtime.measure(**given)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"RealTime\.priority = 0: must lie in \[1, 99\]"):
        realtime.RealTime(priority=0)


def test_enforce_says_what_is_missing() -> None:
    wanted = realtime.RealTime(cpu=1023)
    with pytest.raises(RuntimeError, match="CPU 1023 was not granted"):
        realtime.measure(seconds=0.1, mode="enforce", options=wanted)


def test_cyclictest_is_read() -> None:
    found = parse_cyclictest(HISTOGRAM)
    assert found is not None
    assert found.counts.tolist() == [0, 10, 80, 9]
    assert (found.beyond, found.most) == (1, pytest.approx(7e-3))
    assert found.percentile(50) == pytest.approx(2e-6)
    assert found.percentile(99.9) == pytest.approx(7e-3)
    assert parse_cyclictest("cyclictest: unable to change policy") is None


def write(root: Path, **files: str) -> None:
    for name, text in files.items():
        path = root / name.replace("__", "/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def find(root: Path, what: str) -> realtime.Finding:
    return next(f for f in realtime.examine(root=root) if f.what == what)


@pytest.mark.slow
def test_the_doctor_reads_a_machine(tmp_path: Path) -> None:
    write(
        tmp_path,
        sys__kernel__realtime="1\n",
        sys__devices__system__clocksource__clocksource0__current_clocksource="hpet\n",
        sys__devices__system__clocksource__clocksource0__available_clocksource="hpet tsc\n",
        sys__devices__system__cpu__cpu0__cpufreq__scaling_governor="powersave\n",
        proc__sys__kernel__sched_rt_runtime_us="-1\n",
        proc__sys__kernel__sched_rt_period_us="1000000\n",
        sys__class__net__can0__type="280\n",
        sys__class__net__can0__flags="0x40080\n",
        sys__class__net__can1__type="280\n",
        sys__class__net__can1__flags="0x400c1\n",
        sys__class__net__eth0__type="1\n",
    )
    assert find(tmp_path, "kernel").verdict == "good"
    assert "tsc" in find(tmp_path, "clock source").remedy
    assert "performance" in find(tmp_path, "governor").remedy
    assert find(tmp_path, "share of real-time threads").found == "no limit"
    down = find(tmp_path, "CAN interface can0")
    assert (down.verdict, down.remedy) == (
        "bad",
        "sudo ip link set can0 up type can bitrate 1000000",
    )
    assert find(tmp_path, "CAN interface can1").verdict == "good"
    assert not [f for f in realtime.examine(root=tmp_path) if "eth0" in f.what]


@pytest.mark.slow
def test_the_doctor_of_an_empty_machine_says_unknown(tmp_path: Path) -> None:
    assert find(tmp_path, "clock source").found == "unknown"
    assert find(tmp_path, "CAN interface").found == "none"
    assert "PREEMPT_RT" in find(tmp_path, "kernel").remedy


def test_what_is_not_good_has_a_remedy() -> None:
    for finding in realtime.examine():
        assert finding.verdict == "good" or finding.remedy or finding.found == "unknown", finding


def test_the_doctor_on_the_command_line() -> None:
    ran = CliRunner().invoke(app, ["doctor", "--cpu", "1023", "--json"])
    assert ran.exit_code == 1
    found = json.loads(ran.stdout)
    assert found["verdict"] == "bad"
    cpu = next(row for row in found["rows"] if row["what"] == "thread: cpu")
    assert "taskset -c 1023" in cpu["remedy"]
    assert "what" in CliRunner().invoke(app, ["doctor"]).output


def test_jitter_on_the_command_line(tmp_path: Path) -> None:
    out = tmp_path / "jitter"
    ran = CliRunner().invoke(
        app,
        ["jitter", "--seconds", "0.1", "--realtime", "off", "--alone", "--json", "--out", str(out)],
    )
    assert ran.exit_code == 0, ran.output
    found = json.loads(ran.stdout)
    assert found["rows"][0]["program"] == "ebac"
    assert found["times_cyclictest_p99_9"] is None
    assert (out / "jitter.png").stat().st_size > 1000
    refused = CliRunner().invoke(app, ["jitter", "--realtime", "enforce", "--cpu", "1023"])
    assert refused.exit_code == 1
    assert "CPU 1023" in refused.output


def test_every_mode_of_the_core_has_its_name() -> None:
    assert {mode_named(name) for name in MODES} == set(realtime.RealTimeMode)


def test_turns_are_pooled() -> None:
    one = realtime.Jitter(lateness=np.array([1e-6, 2e-6]), dt=1e-3, skipped=1, grants=[])
    two = realtime.Jitter(lateness=np.array([9e-6]), dt=1e-3, skipped=2, grants=[])
    both = realtime.Jitter.pooled([one, two])
    assert both.lateness.tolist() == [1e-6, 2e-6, 9e-6]
    assert both.skipped == 3
    few = realtime.Cyclictest(counts=np.array([1, 2]), beyond=1, most=5e-3)
    many = realtime.Cyclictest(counts=np.array([1, 0, 4]), beyond=0, most=2e-6)
    pooled = realtime.Cyclictest.pooled([few, many])
    assert (pooled.counts.tolist(), pooled.beyond, pooled.most) == ([2, 2, 4], 1, 5e-3)


@pytest.mark.slow
def test_both_programs_take_turns() -> None:
    turns: list[tuple[int, int]] = []
    found, other = realtime.beside_cyclictest(
        seconds=2.2, rate=100, mode="off", progress=lambda *turn: turns.append(turn)
    )
    assert turns == [(1, 2), (2, 2)]
    assert len(found.lateness) + found.skipped >= 220
    assert (other is None) == (realtime.cyclictest(seconds=0.1, rate=100, priority=None) is None)
    if other is not None:
        assert other.row()["wakeups"] == 220


def test_a_figure_with_both_programs(tmp_path: Path) -> None:
    from ebac.plot import plot_jitter

    found = realtime.Jitter(lateness=np.array([1e-6, 20e-6, 2e-3]), dt=1e-3, skipped=1, grants=[])
    figure = plot_jitter(found, parse_cyclictest(HISTOGRAM))
    assert "cyclictest: 100 wake-ups" in str(
        [t.get_text() for t in figure.axes[0].get_legend().get_texts()]
    )
