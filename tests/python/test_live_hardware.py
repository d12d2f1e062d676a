"""`ebac live` on drives opened as hardware is: no page gets power that may not, none widens a limit."""

import asyncio
import contextlib
import dataclasses
import json
import math
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ebac import datasets
from ebac._core import Free, Wall
from ebac.hardware import Configuration, OpenDevice, drive_setup
from ebac.hardware.backends import simulated
from ebac.hardware.patience import LONGEST_STEP, patient
from ebac.live import serve

websockets = pytest.importorskip("websockets.asyncio.client")
pytestmark = pytest.mark.real_time


#: The target of the hand on the simulated device.
HAND: list[Any] = []


@pytest.fixture
def device(monkeypatch: pytest.MonkeyPatch) -> Iterator[OpenDevice]:
    """Give drives in a thread of C++ and a sensor over UDP, opened as real ones: nothing knows that they are not."""
    nodes_of = (
        drive_setup.nodes_of
    )  # drives as patient as simulated ones: real ones stop after 20 ms of silence
    monkeypatch.setattr(
        drive_setup, "nodes_of", lambda known, simulate: nodes_of(known, simulate=True)
    )
    known = Configuration.from_toml(datasets.joystick_text("joystick"), name="joystick")
    known = patient(known, pause=0.5).replace(mode="off")  # for a busy machine
    with simulated(known, longest_step=LONGEST_STEP * known.timing.dt) as backend:
        assert backend.sensor is not None
        sensor = dataclasses.replace(backend.sensor, http_port=0)
        wired = known.replace(
            interface="ebac", channel=backend.channel, sensor=sensor, setup="apply"
        )
        HAND[:] = [backend.aim]
        with OpenDevice.open(wired) as one:
            yield one


def page_of(server: Any, role: str = "control") -> Any:
    gate = server.gate
    secret = gate.control if role == "control" else gate.watch
    address = f"127.0.0.1:{gate.port}"
    return websockets.connect(
        f"ws://{address}/socket?token={secret}", origin=f"http://{address}", max_queue=None
    )


def ask(what: Callable[[], Awaitable[None]]) -> None:
    asyncio.run(asyncio.wait_for(what(), 60))


async def say(page: Any, kind: str, **more: Any) -> None:
    await page.send(json.dumps({"kind": kind, **more}))


async def until(page: Any, kind: str) -> dict[str, Any]:
    while True:
        message = json.loads(await page.recv())
        if message["kind"] == kind:
            return dict(message)


async def hold(page: Any) -> None:
    while True:
        await say(page, "hold")
        await asyncio.sleep(0.05)


@contextlib.asynccontextmanager
async def holding(page: Any) -> AsyncIterator[None]:
    """Hold the dead-man key in the block."""
    task = asyncio.create_task(hold(page))
    try:
        yield
    finally:
        task.cancel()


async def power(page: Any, server: Any) -> None:
    """Start, with the hand outside, then press; the key must be held."""
    aim(0.0)
    await asyncio.sleep(0.4)
    await say(page, "start")
    await true(lambda: server.session.running and server.session.run.ticks > 300)
    aim(0.02)
    await true(lambda: pressing(server))


async def true(what: Callable[[], bool]) -> None:
    begun = time.monotonic()
    while not what():
        assert time.monotonic() - begun < 10
        await asyncio.sleep(0.02)


def aim(place: float) -> None:
    HAND[0].post([place, math.nan, math.nan])


def pressing(server: Any) -> bool:
    """Whether the loop gives force."""
    run = server.session.run
    return run is not None and not run.done and float(np.abs(run.tail(1)["f_cmd"]).max()) > 1


def at_rest(server: Any) -> Any:
    """Wait for the end of the run; return its report."""
    run, begun = server.session.run, time.monotonic()
    while run.report is None:
        assert time.monotonic() - begun < 3
        time.sleep(0.01)
    return run.report


#: All that a page can say, beside what only a controller may.
EVERYTHING = [
    {"kind": "take"}, {"kind": "hold"}, {"kind": "start"}, {"kind": "hold"}, {"kind": "reset"},
    {"kind": "change", "name": "law", "value": "tca"}, {"kind": "drag", "place": [0.02, 0]},
    {"kind": "change", "name": "stiffness", "value": 100.0}, {"kind": "mode", "mode": "tap"},
    {"kind": "change", "name": "world", "value": "free"}, {"kind": "record", "on": True},
    {"kind": "save"}, {"kind": "pause"}, {"kind": "drop"}, {"kind": "release"},
]  # fmt: skip


def test_without_allow_control_no_message_gives_power_or_changes_anything(
    device: OpenDevice, tmp_path: Path
) -> None:
    with serve(device=device, folder=tmp_path) as server:
        session = server.session
        before = session.choices
        place = list(session.hand.place)

        async def asked() -> None:
            async with page_of(server) as page, page_of(server, "watch") as watching:
                for one in (page, watching):
                    state = await until(one, "state")
                    assert (state["role"], state["free"], state["real"]) == ("watch", False, True)
                    for _ in range(3):
                        for message in EVERYTHING:
                            await one.send(json.dumps(message))
                    for _ in range(3 * (len(EVERYTHING) - 1)):
                        assert "only watches" in (await until(one, "error"))["text"]

        ask(asked)
        assert session.run is None
        assert session.starts == 0
        assert session.choices == before
        assert list(session.hand.place) == place
        assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_power_is_there_while_the_key_is_held_and_ends_with_it(
    device: OpenDevice, tmp_path: Path
) -> None:
    with serve(device=device, allow_control=True, folder=tmp_path) as server:
        session = server.session

        def ended(since: float) -> None:
            report = at_rest(server)
            assert time.monotonic() - since < 2.5
            assert report.ended_by == "dead-man key"
            assert all(state == "switch on disabled" for state in report.drives), report.drives
            assert len(report.drives) == 2
            tail = session.run.tail(10)
            assert not tail["f_cmd"].any()
            assert not tail["current"].any()

        async def asked() -> None:
            async with page_of(server) as page:
                await steps(page)

        async def steps(page: Any) -> None:
            await until(page, "state")
            await say(page, "start")
            assert "nobody holds the dead-man key" in (await until(page, "error"))["text"]
            assert session.run is None

            async with holding(page):
                await power(page, server)
            await say(page, "release")
            ended(time.monotonic())

            async with holding(page):
                await power(page, server)
            ended(time.monotonic())  # silent

            async with page_of(server) as second:
                await until(second, "state")
                async with holding(page):
                    await power(page, server)
                    for message in EVERYTHING[1:4]:
                        await second.send(json.dumps(message))
                        assert "only watches" in (await until(second, "error"))["text"]
                    assert session.running
                page.transport.abort()  # connection lost
                gone = time.monotonic()
                async with holding(second):  # which only watches: its key is nobody's
                    await asyncio.to_thread(ended, gone)
                await say(second, "start")
                assert "only watches" in (await until(second, "error"))["text"]
                await say(second, "take")
                await say(second, "start")  # who takes over holds nothing yet
                text = ""
                while "nobody holds" not in text:
                    text = (await until(second, "error"))["text"]

        ask(asked)
        assert session.starts == 3


def test_no_page_widens_a_limit_of_the_file(device: OpenDevice, tmp_path: Path) -> None:
    own = device.configuration.environment
    assert isinstance(own, Wall)
    limits = device.configuration.limits
    with serve(device=device, allow_control=True, folder=tmp_path) as server:
        session = server.session

        async def refused(page: Any, name: str, value: object, words: str) -> None:
            await say(page, "change", name=name, value=value)
            text = (await until(page, "error"))["text"]
            assert words in text, text

        async def asked() -> None:
            async with page_of(server) as page, contextlib.AsyncExitStack() as stack:
                ranges = (await until(page, "state"))["ranges"]
                assert ranges["stiffness"][1] == own.stiffness
                assert ranges["damping"][1] == own.damping
                for powered in (False, True):
                    if powered:
                        await stack.enter_async_context(holding(page))
                        await power(page, server)
                    await refused(page, "stiffness", own.stiffness + 1, "--max-stiffness")
                    await refused(page, "damping", own.damping + 1.0, "no page can raise that")
                    for name in ("delay", "hand", "device", "observer"):
                        value = {"delay": 2, "observer": not session.choices.observer}.get(
                            name, {"hand": "finger", "device": "joystick-3"}.get(name)
                        )
                        await refused(page, name, value, "cannot change on this device")
                    for name in ("limits", "speed", "peak_current", "end", "max_stiffness"):
                        await refused(page, name, 1e6, "no setting is called")
                    await refused(page, "world", "soft", "no number of N/m")
                await say(page, "change", name="stiffness", value=own.stiffness / 2)
                await true(lambda: session.run.environment.stiffness == own.stiffness / 2)
                await say(page, "change", name="world", value="free")
                await true(lambda: isinstance(session.run.environment, Free))
                await stack.aclose()
                await say(page, "release")

        ask(asked)
        run = session.run
        at_rest(server)
        assert not session.fault
        assert isinstance(run.environment, Free)
        assert device.configuration.limits == limits
        assert session._chosen().limits == limits
        force = np.abs(run.tail(100_000)["f_cmd"])
        assert force.max() <= device.configuration.device.force(limits.peak_current)
