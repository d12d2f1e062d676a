"""What the tests share: cached runs of scenarios, hypothesis profiles, a bus, a device with its sensor.

More examples than usual: `pytest --hypothesis-profile=explore`.

A test marked `real_time` runs a loop against the clock, and a machine that is late brings less in the same seconds. One
that fails is repeated while no other worker runs a test: seven times at most where a loop in it ended because this
machine kept it or what answers it waiting, twice at most after any other failure. The summary says so.
"""

import fcntl
import gc
import importlib.util
import os
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from functools import cache
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

import json_page
import plain_pictures
import pytest
import typer.testing
from _pytest.runner import runtestprotocol
from busy_machine import LATE
from hypothesis import settings
from hypothesis.internal.conjecture import providers

import ebac

if TYPE_CHECKING:
    import can

    from ebac import ForceSensor
    from ebac.hardware import Configuration, OpenDevice, Run
    from ebac.sensor import SensorConfig, SharedForce, SimulatedSensor

settings.register_profile("ebac", deadline=None, max_examples=25, derandomize=True, database=None)
# Where CI is set, hypothesis is not random unless told so.
settings.register_profile(
    "explore", deadline=None, max_examples=5000, derandomize=False, database=None, print_blob=True
)
settings.load_profile("ebac")
# Hypothesis tries numbers that stand in the modules imported so far, unless these are installed: a failure in CI would
# not show in a clone, nor in a worker that had imported others. No setting turns that off.
providers.is_local_module_file = lambda path: False  # type: ignore[attr-defined]

# A runner builds all commands of a program at every call: 40 ms, most of what a test of a wrong option takes.
typer.testing._get_command = cache(typer.testing._get_command)

# Arrow's own allocator reserves 1 GiB, which a loop in real time then locks into memory: 20 s where pages are slow.
os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")

# A shell that starts pytest in the background has these ignored, and every program that a test interrupts would too.
for _number, _usual in (
    (signal.SIGINT, signal.default_int_handler),
    (signal.SIGQUIT, signal.SIG_DFL),
):
    if signal.getsignal(_number) is signal.SIG_IGN:
        signal.signal(_number, _usual)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Let an idle worker of `pytest -n` take tests from a busy one: those of the pages are long and stand together."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log) if config.getoption("dist") == "load" else None


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int | None:
    """Return two workers more than cores for `pytest -n auto`: many tests wait for a loop or a process."""
    if "PYTEST_XDIST_AUTO_NUM_WORKERS" in os.environ:
        return None
    affinity = getattr(os, "sched_getaffinity", None)
    return 2 + (len(affinity(0)) if affinity else os.cpu_count() or 1)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Make slow tests weekly but for the first of their sets of parameters, unless `slow(every=True)`."""
    sets: dict[str, list[pytest.Item]] = {}
    for item in items:
        slow = item.get_closest_marker("slow")
        if slow and not slow.kwargs.get("every") and not item.get_closest_marker("weekly"):
            sets.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for same in sets.values():
        for item in same[1:]:
            item.add_marker(pytest.mark.weekly)


def pytest_collection_finish() -> None:
    """Keep what was imported out of garbage collections: they took a tenth of the time and freed none of it."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)


@pytest.fixture(scope="module", autouse=True)
def pictures(request: pytest.FixtureRequest) -> Iterator[None]:
    """Draw pictures without laying them out, but in tests of pictures."""
    with pytest.MonkeyPatch.context() as patch:
        if request.path.stem not in ("test_figures", "test_plot"):
            patch.setattr(plain_pictures.SAVE, "write_png", plain_pictures.draw_plain)
        yield


@pytest.fixture(scope="module", autouse=True)
def keys_of_json() -> Iterator[None]:
    """Fail where a command printed a key with `--json` that docs/reference/json.md does not have."""
    output = sys.modules.get("ebac.cli.output")
    if output is None:  # no command runs in this module
        yield
        return
    missing = set[str]()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(output, "document", json_page.looked_at(output.document, missing))
        yield
    assert not missing, f"not in {json_page.PAGE.name}: {', '.join(sorted(missing))}"


@cache
def _run(law: str, changes: tuple[tuple[str, Any], ...]) -> ebac.Trace:
    return ebac.simulate(ebac.Scenario(**dict(changes)), law)


@pytest.fixture(scope="session")
def run() -> Callable[..., ebac.Trace]:
    """`run("eba", seconds=1.0)`: the reference scenario, partly changed, simulated once."""

    def simulate(law: str, **changes: Any) -> ebac.Trace:
        return _run(law, tuple(sorted(changes.items())))

    return simulate


@pytest.fixture(scope="session")
def of_each() -> Callable[[dict[str, Any], Callable[[Any], None]], None]:
    """Return a function that checks every case, by its name, and then reports all that fail."""

    def check_all(cases: dict[str, Any], check: Callable[[Any], None]) -> None:
        wrong = []
        for name, case in cases.items():
            try:
                check(case)
            except (Exception, pytest.fail.Exception) as failure:
                wrong.append(f"{name}: {failure}")
        if wrong:
            pytest.fail("\n".join(wrong), pytrace=False)

    return check_all


@pytest.fixture(scope="session")
def until() -> Callable[["Run", Callable[[], bool]], None]:
    """A function that waits for something that happens while a loop runs."""

    def wait(run: "Run", reached: Callable[[], bool]) -> None:
        while not reached():
            if run.done:
                run.finish()  # raises, where it was a fault
            assert not run.done
            time.sleep(0.01)

    return wait


@pytest.fixture(scope="session")
def at_tick() -> Callable[[int, Callable[[], None]], Callable[["Run"], None]]:
    """`look=at_tick(200, act)`: acts once in a run, after that tick."""

    def make(tick: int, act: Callable[[], None]) -> Callable[["Run"], None]:
        waits = True

        def look(run: "Run") -> None:
            nonlocal waits
            if waits and run.ticks > tick:
                act()
                waits = False

        return look

    return make


@pytest.fixture
def open_with_sensor() -> Callable[
    ["Configuration"], AbstractContextManager[tuple["OpenDevice", "SimulatedSensor"]]
]:
    """A function that opens a device on simulated drives, with its simulated force sensor."""
    from ebac.hardware import backends
    from ebac.sensor import SimulatedSensor

    @contextmanager
    def opened(known: "Configuration") -> Iterator[tuple["OpenDevice", SimulatedSensor]]:
        made: list[SimulatedSensor] = []

        @contextmanager
        def beside(
            config: "SensorConfig", own: "ForceSensor", shared_force: "SharedForce", *_: object
        ) -> Iterator["SensorConfig"]:
            with SimulatedSensor(shared_force) as sensor:
                made.append(sensor)
                yield sensor.config

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(backends, "sensor_of", beside)
            patch.setattr(backends, "virtual_can", lambda: None)
            with ebac.Device.open(known, simulate=True) as device:
                yield device, made[0]

    return opened


_CHANNELS = count()


@pytest.fixture
def open_bus() -> Iterator[Callable[[], "can.BusABC"]]:
    """A function that opens a bus with the simulated drives of the joystick on it, nodes 1 and 2."""
    import can

    from ebac.can.interface import EbacBus

    channel = f"joystick-{next(_CHANNELS)}"
    with EbacBus(channel) as first:
        for node in (
            1,
            2,
        ):  # an answer comes behind the boot-up, which a bus that is opened later then does not see
            ask = [0x40, 0x00, 0x10, 0, 0, 0, 0, 0]
            first.send(can.Message(arbitration_id=0x600 + node, data=ask, is_extended_id=False))
            while (seen := first.recv(5)) is not None and seen.arbitration_id != 0x580 + node:
                pass
        yield lambda: EbacBus(channel)


#: How often a test is repeated at most: after a stall, and after any other failure.
_STALLS, _OTHERS = 7, 2


def pytest_configure(config: pytest.Config) -> None:
    """Know the marker."""
    config.addinivalue_line(
        "markers", "real_time: runs a loop against the clock; repeated alone where it fails"
    )


@contextmanager
def _machine(alone: bool) -> Iterator[None]:
    """Hold the machine for a test: beside those of other workers, or alone.

    Who runs holds this file locked. Who waits for it holds its folder, so that those who come later cannot overtake.
    """
    held = os.open(__file__, os.O_RDONLY)
    turn = os.open(Path(__file__).parent, os.O_RDONLY)
    try:
        fcntl.flock(turn, fcntl.LOCK_EX)
        fcntl.flock(held, fcntl.LOCK_EX if alone else fcntl.LOCK_SH)
        fcntl.flock(turn, fcntl.LOCK_UN)
        yield
    finally:
        os.close(turn)
        os.close(held)


def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> bool:
    """Run a test; one of the clock again, alone, where it fails."""
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    stalls = others = 0
    while True:
        with _machine(alone=stalls + others > 0):
            reports = runtestprotocol(item, nextitem=nextitem, log=False)  # with fixtures anew
        failed = [_message(one) for one in reports if one.failed]
        if not failed or item.get_closest_marker("real_time") is None:
            break
        if all(LATE.search(words) for words in failed):
            stalls += 1
        else:
            others += 1
        if stalls > _STALLS or others > _OTHERS:
            break
        fault = LATE.search(failed[0])
        why = fault[0] if fault else failed[0].partition("\n")[0]
        item.user_properties.append(("repeated", why))
    for report in reports:
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True


def _message(report: pytest.TestReport) -> str:
    """Return what was raised: its words, not the lines of the test, which may speak of faults."""
    crash = getattr(report.longrepr, "reprcrash", None)
    return "" if crash is None else crash.message


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Say what was repeated, and why."""
    for found in ("passed", "failed"):
        for report in terminalreporter.stats.get(found, []):
            why = [value for name, value in report.user_properties if name == "repeated"]
            if why:
                told = f"repeated alone: {report.nodeid}: {', '.join(why)}"
                terminalreporter.write_line(told, yellow=True)


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Debian's chromium, driven by playwright; skipped where either is missing. EBAC_CHROMIUM names another."""
    sync_api = pytest.importorskip("playwright.sync_api")
    chromium = os.environ.get("EBAC_CHROMIUM") or shutil.which("chromium")
    if not chromium:
        pytest.skip("no chromium; EBAC_CHROMIUM may name one")
    with sync_api.sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        yield opened
        opened.close()


@pytest.fixture(scope="session")
def wasm() -> bytes:
    """The module of these sources: made before, by the build of the site, or now where a compiler is."""
    root = Path(__file__).parents[2]
    found = importlib.util.spec_from_file_location("build", root / "bindings" / "wasm" / "build.py")
    assert found is not None
    assert found.loader is not None
    build: Any = importlib.util.module_from_spec(found)
    found.loader.exec_module(build)
    place = root / "build" / "wasm" / "ebac.wasm"
    if not build.fresh(place) and not build.compiler():
        pytest.skip("no ziglang to compile the core to WebAssembly")
    made: bytes = build.built(place).read_bytes()
    return made


@pytest.fixture
def placed(wasm: bytes, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> bytes:
    """The module where the package looks for it."""
    monkeypatch.setattr("ebac.live.wasm_module.PLACE", tmp_path / "ebac.wasm")
    (tmp_path / "ebac.wasm").write_bytes(wasm)
    return wasm
