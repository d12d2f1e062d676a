"""Sweeps: the numbers of single runs, whoever computes them, and after an interruption too."""

import csv
import os
import pickle
import signal
import subprocess
import sys
import time
import types
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ebac
from ebac import Operators, SweepResult, sweep
from ebac.metrics.wall_contact import COLUMNS, FLAGS
from ebac.studies.sweeps.run import seed_of

LAWS = ["tca", "ebac"]


def scenarios(n: int = 7, **changes: Any) -> list[ebac.Scenario]:
    device = ebac.Device(sensor=ebac.ForceSensor(noise=0.1))
    base = ebac.Scenario(device=device, seconds=0.5, jitter=0.1).replace(**changes)
    return Operators.sample(n, 1).scenarios(base)


def assert_same_bits(a: SweepResult, b: SweepResult) -> None:
    assert list(a) == list(b)
    for name in a:
        assert a[name].dtype == b[name].dtype, name
        assert a[name].tobytes() == b[name].tobytes(), name


@pytest.fixture(scope="module")
def local() -> SweepResult:
    return sweep(scenarios(), LAWS, seed=3)


class Spring:
    """A law in Python; at the top of a module, so that it can travel to another process."""

    name = "spring"

    def __init__(self, share: float = 1.0) -> None:
        self.share = share

    def step(self, port: ebac.Port) -> float:
        return min(self.share * port.f_env, 42.4)

    def reset(self) -> None:
        pass


def test_a_law_is_designed_once_for_equal_facts_and_timing(monkeypatch: pytest.MonkeyPatch) -> None:
    """The design of `virtual-coupling` takes 6 ms; a study has equal facts in thousands of objects."""
    designed: list[object] = []

    def count(law: ebac.laws.AnyLaw, device: object, timing: ebac.Timing) -> object:
        designed.append(device)
        return ebac.design("ebac", ebac.Device(), timing)

    monkeypatch.setattr("ebac.studies.sweeps.run.design", count)
    every = scenarios()
    damped = ebac.DeviceFacts(damping=3.0)
    known = [(s.device.facts, s.known_timing.replace(jitter=0.1)) for s in every[:4]]
    known += [(damped.replace(mass=0.25), ebac.Timing(delay=d)) for d in (1, 1, 2)]
    sweep([s.replace(seconds=0.01) for s in every], "ebac", designed_for=known)
    assert len(designed) == 3


def test_a_sweep_has_the_numbers_of_single_runs(local: SweepResult) -> None:
    every = scenarios()
    for i in range(len(local)):
        scenario = every[local["scenario"][i]].replace(seed=int(local["seed"][i]))
        single = ebac.contact(ebac.simulate(scenario, str(local["law"][i])))
        for name in (*COLUMNS, *FLAGS):
            value = getattr(single, name)
            assert value == local[name][i] or (value is None and np.isnan(local[name][i])), name
        assert local["ideal_m"][i] == single.ideal_m
        assert local.deviation_m[i] == single.deviation_m
        assert local.good[i] == (single.quiet and single.exact)
    not_quiet = SweepResult({**local.columns, "quiet": np.zeros(len(local), bool)})
    assert not not_quiet.good.any()
    assert local["done"].all()
    assert (local["ticks"] == 501).all()


def test_seeds_come_from_seed_and_place_and_are_those_of_every_machine() -> None:
    assert seed_of(1, 0) == 3717377837946358015
    result = sweep(scenarios(3), "direct", seed=5)
    assert result["seed"].tolist() == [seed_of(5, i) for i in range(3)]
    assert sweep(scenarios(3), "direct")["seed"].tolist() == [1, 1, 1]


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_the_number_of_threads_changes_nothing(threads: int, local: SweepResult) -> None:
    assert_same_bits(sweep(scenarios(), LAWS, seed=3, threads=threads), local)


def test_an_executor_of_threads_gives_the_same_bits(local: SweepResult) -> None:
    with ThreadPoolExecutor(2) as executor:
        assert_same_bits(sweep(scenarios(), LAWS, seed=3, executor=executor, bundle=3), local)


@pytest.mark.slow
def test_an_executor_of_processes_gives_the_same_bits(local: SweepResult) -> None:
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        assert_same_bits(sweep(scenarios(), LAWS, seed=3, executor=executor, bundle=3), local)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.slow
@pytest.mark.weekly
def test_a_dask_cluster_of_two_processes_gives_the_same_bits(local: SweepResult) -> None:
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    )
    with cluster, distributed.Client(cluster) as client:
        executor = client.get_executor()
        assert_same_bits(sweep(scenarios(), LAWS, seed=3, executor=executor, bundle=3), local)


def test_a_law_in_python_is_measured_like_one_of_the_core() -> None:
    short = scenarios(3, seconds=0.2)
    mixed = sweep(short, {"spring": Spring(), "direct": "direct"}, seed=1)
    python, core = (SweepResult({n: mixed[n][p] for n in mixed}) for p in (slice(3), slice(3, 6)))
    for name in (*COLUMNS, *FLAGS, "ticks", "fault", "diverged", "done"):
        np.testing.assert_array_equal(python[name], core[name], err_msg=name)


def test_laws_may_be_instances_and_variants_by_name() -> None:
    device, timing = ebac.Device(), ebac.Timing()
    made = ebac.design("tca", device, timing)
    result = sweep(scenarios(2), {"as designed": "tca", "given": made, "class": ebac.TCA}, seed=1)
    np.testing.assert_array_equal(result["swing_m"][:2], result["swing_m"][2:4])
    np.testing.assert_array_equal(result["swing_m"][:2], result["swing_m"][4:])
    with pytest.raises(ValueError, match="two laws are called 'tca'"):
        sweep(scenarios(2), ["tca", made])


def test_laws_can_be_designed_for_another_device() -> None:
    one = scenarios(2)
    told = [(s.device.facts.replace(mass=0.1), s.timing) for s in one]
    result = sweep(one, "ebac", designed_for=told)
    expected = ebac.simulate(one[1], ebac.design("ebac", *told[1]))
    assert result["rest_m"][1] == ebac.contact(expected).rest_m
    with pytest.raises(ValueError, match="designed_for has 1 entries for 2 scenarios"):
        sweep(one, "ebac", designed_for=told[:1])


class Designed(Spring):
    """A spring that is designed: its share is the delay that it is told."""

    name = "designed"

    @classmethod
    def design(cls, facts: ebac.DeviceFacts, timing: ebac.Timing) -> "Designed":
        assert facts.mass == ebac.Device().mass
        return cls(0.1 * timing.delay)


def test_a_class_in_python_is_designed_for_each_scenario() -> None:
    few = [s.replace(timing=ebac.Timing(delay=delay)) for s in scenarios(1) for delay in (1, 3)]
    found = sweep(few, Designed)
    assert set(found["law"]) == {"designed"}
    by_hand = [sweep([one], Spring(0.1 * one.timing.delay)) for one in few]
    np.testing.assert_array_equal(found["rest_m"], [one["rest_m"][0] for one in by_hand])
    assert np.isclose(
        ebac.simulate(few[1], Designed)["f_cmd"][-1],
        0.3 * ebac.simulate(few[1], Designed)["f_env"][-1],
    )


def test_a_finished_law_for_another_sample_time_is_reported() -> None:
    fast = scenarios(1)[0].replace(timing=ebac.Timing(dt=5e-4))
    with pytest.warns(UserWarning, match="eba is made for dt = 0.001 s and runs at 0.0005 s"):
        ebac.simulate(fast, ebac.EBA())
    ebac.simulate(fast, ebac.EBA(timing=fast.timing))


def test_names_of_laws_may_be_numbers() -> None:
    found = sweep(scenarios(1), {0.25: Spring(0.25), 0.5: Spring(0.5)})  # type: ignore[dict-item]
    assert list(found["law"]) == ["0.25", "0.5"]
    assert "0.25" in str(found)


class Away(Spring):
    name = "away"

    def step(self, port: ebac.Port) -> float:
        return -40.0


class Nothing(Spring):
    name = "nothing"

    def step(self, port: ebac.Port) -> float:
        return float("nan") if port.x > 0.001 else 0.0


def test_a_run_that_diverges_ends_early_and_says_so() -> None:
    open_hand = ebac.presets.hand("open")
    away = ebac.Scenario(hand=open_hand, seconds=2.0)
    result = sweep([away], Away(), limits=ebac.RunLimits(position=0.2))
    assert result["diverged"][0]
    assert result["ticks"][0] < 500
    assert not result.good[0]
    assert 0.2 < result["peak_m"][0] < 0.21


def test_a_run_that_stops_on_a_fault_says_so() -> None:
    result = sweep(scenarios(1), Nothing())
    assert ebac.Fault(int(result["fault"][0])) is ebac.Fault.LAW_NOT_FINITE
    assert result["ticks"][0] < 501
    assert np.isnan(result["settled_s"][0])


# --- progress and interruption ---


def test_progress_rises_to_the_end() -> None:
    seen: list[tuple[int, int]] = []
    sweep(scenarios(seconds=20.0), LAWS, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (14, 14)
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)
    assert {total for _, total in seen} == {14}


@pytest.mark.real_time
def test_a_keyboard_interrupt_stops_soon_and_keeps_what_is_done() -> None:
    long = [s.replace(seconds=2000.0) for s in scenarios(30)]
    asked: list[float] = []

    def interrupt(done: int, total: int) -> None:
        if done >= 2 and not asked:
            asked.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(ebac.SweepInterrupted) as stopped:
        sweep([*scenarios(2), *long], "tca", threads=2, progress=interrupt)
    assert time.perf_counter() - asked[0] < 0.2 + 0.3  # what is promised, and a busy machine
    result = stopped.value.result
    assert result["done"][:2].all()
    assert 2 <= result["done"].sum() < 32
    assert not np.isfinite(result["rest_m"][~result["done"]]).any()
    assert result["rest_m"][0] == sweep(scenarios(2), "tca")["rest_m"][0]
    assert f"{result['done'].sum()} of 32 runs" in str(stopped.value)
    assert isinstance(stopped.value, KeyboardInterrupt)
    again = pickle.loads(pickle.dumps(stopped.value))
    assert_same_bits(again.result, stopped.value.result)


class Dying(Executor):
    """Computes some bundles and then breaks."""

    def __init__(self, bundles: int) -> None:
        self.left = bundles

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.left -= 1
        if self.left < 0:
            future.set_exception(RuntimeError("the machine is gone"))
        else:
            future.set_result(fn(*args, **kwargs))
        return future


def test_a_sweep_that_broke_continues_and_gives_the_same_bits(
    tmp_path: Path, local: SweepResult
) -> None:
    out = tmp_path / "sweep"
    with pytest.raises(RuntimeError, match="the machine is gone"):
        sweep(scenarios(), LAWS, seed=3, bundle=3, out=out, executor=Dying(2))
    kept = sorted(file.name for file in out.glob("bundle-*"))
    assert 0 < len(kept) <= 2
    stamps = {name: (out / name).stat().st_mtime_ns for name in kept}
    assert_same_bits(sweep(scenarios(), LAWS, seed=3, bundle=3, out=out), local)
    assert {name: (out / name).stat().st_mtime_ns for name in kept} == stamps
    assert not list(out.glob(".*"))


KILLED = """
import sys, ebac
from ebac import Operators, sweep
base = ebac.Scenario(seconds=30.0)
sweep(Operators.sample(60, 1).scenarios(base), "ebac", seed=3, bundle=2, threads=1, out=sys.argv[1])
"""


@pytest.mark.slow
def test_a_sweep_that_was_killed_continues_and_gives_the_same_bits(tmp_path: Path) -> None:
    out = tmp_path / "sweep"
    worker = subprocess.Popen([sys.executable, "-c", KILLED, str(out)])
    while len(list(out.glob("bundle-*"))) < 3 and worker.poll() is None:
        time.sleep(0.005)
    worker.kill()
    worker.wait()
    done = len(list(out.glob("bundle-*")))
    every = Operators.sample(60, 1).scenarios(ebac.Scenario(seconds=30.0))
    resumed = sweep(every, "ebac", seed=3, bundle=2, out=out)
    assert done >= 3
    assert_same_bits(resumed, sweep(every, "ebac", seed=3))


def test_a_folder_of_another_sweep_is_refused(tmp_path: Path) -> None:
    out = tmp_path / "sweep"
    sweep(scenarios(3), "tca", out=out)
    for change in ({"seconds": 0.6}, {"seed": 9}):
        with pytest.raises(ValueError, match=r"holds another sweep \(fingerprint.*resume=False"):
            sweep(scenarios(3, **change), "tca", out=out)
    with pytest.raises(ValueError, match="holds another sweep"):
        sweep(scenarios(3), "eba", out=out)
    fresh = sweep(scenarios(3), "eba", out=out, resume=False)
    assert_same_bits(fresh, sweep(scenarios(3), "eba", out=out))


def test_a_damaged_folder_is_continued_or_begun_anew(tmp_path: Path) -> None:
    """As after a power cut: a bundle was a `BadZipFile` without a name, a manifest refused even a new start."""
    out = tmp_path / "sweep"
    whole = sweep(scenarios(3), "tca", out=out, bundle=1)
    first, second, _ = sorted(out.glob("bundle-*"))
    first.write_bytes(first.read_bytes()[:200])
    second.write_bytes(b"")
    assert_same_bits(sweep(scenarios(3), "tca", out=out, bundle=1), whole)
    for text in ("", '{"runs": 3', "[1]"):
        (out / "sweep.json").write_text(text, encoding="utf-8")
        with pytest.raises(ValueError, match=r"sweep\.json: is damaged; .*resume=False"):
            sweep(scenarios(3), "tca", out=out, bundle=1)
    assert_same_bits(sweep(scenarios(3), "tca", out=out, bundle=1, resume=False), whole)


@pytest.mark.parametrize("resume", [True, False])
def test_a_folder_that_another_sweep_writes_to_is_refused(tmp_path: Path, resume: bool) -> None:
    """Its bundles were mixed with those of the other, and a resumed sweep had numbers of another law."""
    out = tmp_path / "sweep"

    def other(done: int, total: int) -> None:
        with pytest.raises(ValueError, match="another sweep is writing to it"):
            sweep(scenarios(3), "tca", out=out, resume=resume)

    first = sweep(
        scenarios(3), "eba", out=out, progress=lambda done, total: done and other(done, total)
    )
    assert_same_bits(first, sweep(scenarios(3), "eba", out=out))


def test_a_law_in_python_is_known_again_by_its_values(tmp_path: Path) -> None:
    out = tmp_path / "sweep"
    first = sweep(scenarios(2, seconds=0.1), Spring(0.5), out=out)
    assert_same_bits(first, sweep(scenarios(2, seconds=0.1), Spring(0.5), out=out))
    with pytest.raises(ValueError, match="holds another sweep"):
        sweep(scenarios(2, seconds=0.1), Spring(0.6), out=out)


EDITED = """
import ebac
SHARE = {share}
def helped(port):
    return SHARE * port.f_env
class Mine:
    name = "mine"
    def step(self, port):
        return {body}
    def reset(self):
        pass
"""


@pytest.mark.parametrize(
    "edit",
    [
        {"share": 0.6},
        {"body": "-helped(port)"},
        {"body": "helped(port) - 2.0"},
        {"body": "helped(port) * sum([1.0, 0.5, 0.25])"},
    ],
)
def test_a_law_whose_code_was_edited_is_another_law(
    edit: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its results were taken for those of the code before."""

    def law(**changes: Any) -> Any:
        module = types.ModuleType("edited")
        monkeypatch.setitem(sys.modules, "edited", module)
        given = {"share": 0.5, "body": "helped(port) * sum([0.0, 0.5, 0.25])"} | changes
        exec(EDITED.format(**given), vars(module))
        return module.Mine()

    few = scenarios(2, seconds=0.1)
    first = sweep(few, law(), out=tmp_path)
    assert_same_bits(first, sweep(few, law(), out=tmp_path))
    with pytest.raises(ValueError, match=r"holds another sweep.*resume=False"):
        sweep(few, law(**edit), out=tmp_path)


# --- the result ---


def test_scenarios_with_and_without_the_observer_are_distinguished() -> None:
    bare = scenarios(1, seconds=0.1)[0].replace(observer=False)
    designed = bare.replace(observer=ebac.Observer(force_noise=0.1))
    given = [bare, bare.replace(observer=True), designed, bare.replace(observer="every-law")]
    columns = sweep(given, "direct")
    assert [str(one) for one in columns["observer"]] == ["False", "True", "Observer", "every-law"]
    assert columns["observer.force_noise_N"][2] == 0.1


def test_the_result_as_a_table(tmp_path: Path, local: SweepResult) -> None:
    pytest.importorskip("pandas")
    local.to_csv(tmp_path / "sweep.csv")
    with (tmp_path / "sweep.csv").open() as file:
        rows = list(csv.DictReader(file))
    frame = local.to_pandas()
    assert list(rows[0]) == list(frame) == list(local)
    for name in ("swing_m", "settled_s"):
        read = np.array([float(row[name] or "nan") for row in rows])
        np.testing.assert_array_equal(read, local[name])
    assert [row["law"] for row in rows] == frame["law"].tolist() == local["law"].tolist()
    assert "14 runs under tca, ebac, 14 done" in repr(local)
    with pytest.raises(KeyError, match="no column is called 'swing', did you mean 'swing_m'"):
        local["swing"]


def test_the_result_as_parquet(tmp_path: Path, local: SweepResult) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    local.to_parquet(tmp_path / "sweep.parquet")
    read = parquet.read_table(tmp_path / "sweep.parquet").to_pydict()
    assert list(read) == list(local)
    assert read["law"] == local["law"].tolist()
    assert np.array(read["swing_m"]).tobytes() == local["swing_m"].tobytes()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"scenarios": []}, "no scenario given"),
        ({"laws": []}, "no law given"),
        ({"threads": 0}, "threads = 0: must be at least 1"),
        ({"bundle": 0}, "bundle = 0: must be at least 1"),
        ({"seed": -1}, "seed = -1: must be at least 0"),
    ],
)
def test_a_sweep_of_nothing_is_refused(words: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        sweep(**({"scenarios": scenarios(1), "laws": "tca"} | words))


def test_limits_travel_and_are_checked() -> None:
    limits = ebac.RunLimits(position=0.5)
    assert pickle.loads(pickle.dumps(limits)) == limits
    with pytest.raises(ValueError, match=r"RunLimits\.position = 0 m"):
        ebac.RunLimits(position=0.0)


class Pull:
    """A hand of one's own, without a text of its own: the default has an address."""

    def __init__(self, goal: float) -> None:
        self.goal = goal

    def force(self, t: float, x: float, v: float) -> float:
        return 300 * (self.goal - x)


class Slope:
    """A world of one's own, which may be changed between two sweeps."""

    def __init__(self, stiffness: float) -> None:
        self.stiffness = stiffness

    def __call__(self, x: Any, v: Any) -> Any:
        return self.stiffness * np.maximum(x, 0.0)


def test_hands_and_worlds_of_ones_own_are_known_by_what_they_do(tmp_path: Path) -> None:
    """They were known by where they lay in memory: none was known again, and some for others."""

    def made(goal: float, stiffness: float) -> list[ebac.Scenario]:
        return [
            ebac.Scenario(hand=ebac.Hand(model=Pull(goal)), seconds=0.1),
            ebac.Scenario(environment=ebac.worlds.FunctionWorld(Slope(stiffness)), seconds=0.1),
        ]

    first = sweep(made(0.02, 1e3), "direct", out=tmp_path, threads=1)
    assert_same_bits(first, sweep(made(0.02, 1e3), "direct", out=tmp_path, threads=1))
    for other in (made(0.03, 1e3), made(0.02, 2e3)):
        with pytest.raises(ValueError, match="holds another sweep"):
            sweep(other, "direct", out=tmp_path, threads=1)


def test_whoever_is_told_the_progress_may_end_a_sweep() -> None:
    """It went on in the background."""

    def told(done: int, total: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        sweep(scenarios(200, seconds=6.0), "ebac", threads=1, progress=told)
    begin = time.process_time()
    time.sleep(0.2)
    assert time.process_time() - begin < 0.1


def test_the_observer_is_among_what_was_swept() -> None:
    given = [ebac.Scenario(seconds=0.1, observer=observer) for observer in (True, "every-law")]
    assert sweep(given, "tca").swept == ("observer",)
