"""Who may see and control the live server; what no page can do to the loop."""

import asyncio
import contextlib
import json
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path
from socket import create_server
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.live.frames import Frames
from ebac.live.gate import Gate
from ebac.live.messages import MalformedError, read
from ebac.live.serving import serve
from ebac.worlds import Bridge, EngineThread, Sphere, World

websockets = pytest.importorskip("websockets.asyncio.client")
from websockets.exceptions import ConnectionClosed, InvalidStatus  # noqa: E402

pytestmark = pytest.mark.real_time


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Any]:
    with serve(folder=tmp_path) as one:
        yield one


@pytest.fixture(scope="module")
def closed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A server for those whom it refuses: its loop is not touched."""
    with serve(folder=tmp_path_factory.mktemp("closed")) as one:
        yield one


def socket(server: Any, role: str = "control", origin: str | None = None, **more: Any) -> Any:
    gate = server.gate
    secret = {"control": gate.control, "watch": gate.watch}.get(role, role)
    own = f"http://127.0.0.1:{gate.port}"
    url = f"ws://127.0.0.1:{gate.port}/socket?token={secret}"
    return websockets.connect(url, origin=own if origin is None else origin, max_queue=None, **more)


def ask(what: Callable[[], Awaitable[None]]) -> None:
    asyncio.run(asyncio.wait_for(what(), 30))


async def until(page: Any, kind: str, **wanted: Any) -> dict[str, Any]:
    while True:
        message = json.loads(await page.recv())
        if message["kind"] == kind and all(message.get(k) == v for k, v in wanted.items()):
            return message


def status(url: str, **headers: str) -> int:
    request = urllib.request.Request(url, headers=headers)
    try:
        with urllib.request.urlopen(request, timeout=5) as answer:
            return int(answer.status)
    except urllib.error.HTTPError as error:
        return error.code


def test_the_page_needs_its_token_and_its_own_name(closed: Any) -> None:
    base = f"http://127.0.0.1:{closed.gate.port}/"
    with urllib.request.urlopen(closed.gate.url(), timeout=5) as answer:
        assert b"ebac live" in answer.read()
        assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
    assert status(base) == 403
    assert status(f"{base}?token=wrong") == 403
    assert status(closed.gate.url("watch")) == 200
    assert status(closed.gate.url(), Host="evil.example") == 403
    assert status(f"{base}other?token={closed.gate.control}") == 404


@pytest.mark.parametrize(
    ("role", "origin"),
    [
        ("control", "http://evil.example"),
        ("control", "http://localhost:1"),
        ("control", "null"),
        ("wrong", None),
        ("", None),
    ],
)
def test_the_socket_needs_its_token_and_origin(closed: Any, role: str, origin: str | None) -> None:
    async def opened() -> None:
        with pytest.raises(InvalidStatus) as caught:
            async with socket(closed, role, origin):
                pass
        assert caught.value.response.status_code == 403

    ask(opened)


def test_what_strangers_send_is_no_news_and_pages_have_an_end(
    server: Any, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    posted = urllib.request.Request(server.gate.url(), data=b"x", method="POST")
    with pytest.raises((urllib.error.URLError, ConnectionError)):
        urllib.request.urlopen(posted, timeout=5)
    monkeypatch.setattr("ebac.live.server.MOST_PAGES", 2)

    async def opened() -> None:
        async with socket(server, "watch") as first, socket(server, "watch") as second:
            await until(first, "state")
            await until(second, "state")
            with pytest.raises(InvalidStatus) as caught:
                async with socket(server, "watch"):
                    pass
            assert caught.value.response.status_code == 503

    ask(opened)
    assert capfd.readouterr().err == ""


def test_a_server_on_every_address_is_opened_by_the_name_of_its_machine() -> None:
    import socket

    for everywhere in ("0.0.0.0", "::"):
        gate = Gate(host=everywhere, port=8080, control="c", watch="w")
        assert gate.url() == f"http://{socket.gethostname()}:8080/?token=c"


def test_an_origin_must_be_given() -> None:
    gate = Gate(host="127.0.0.1", port=80, control="c", watch="w")
    assert gate.refuses("/socket?token=c", host="127.0.0.1:80", origin=None, socket=True)
    assert gate.refuses("/?token=c", host=None, origin=None, socket=False)
    assert gate.refuses("/?token=c", host="127.0.0.1:80", origin=None, socket=False) is None


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost", "[::1]"])
def test_a_browser_leaves_out_port_80(name: str) -> None:
    gate = Gate(host="127.0.0.1", port=80, control="c", watch="w")
    own = {"host": name, "origin": f"http://{name}"}
    assert gate.refuses("/socket?token=c", **own, socket=True) is None
    other = Gate(host="127.0.0.1", port=8080, control="c", watch="w")
    assert other.refuses("/socket?token=c", **own, socket=True)


def test_a_page_shows_the_bodies_that_an_engine_computes(tmp_path: Path) -> None:
    shapes: list[Any] = []

    async def opened(server: Any) -> None:
        async with socket(server) as page:
            shapes.append((await until(page, "shape"))["shape"])
            await until(page, "frame")

    ball, unknown = World(Sphere()), EngineThread(lambda x, v: None).world
    for world in (ball, Bridge(ball), unknown):
        with serve(ebac.Scenario(environment=world), virtual=True, folder=tmp_path) as server:
            ask(lambda server=server: opened(server))
    assert len(shapes[0][0]) > 1000
    assert shapes[1:] == [shapes[0], [[], []]]


def test_a_frame_that_fails_does_not_end_the_picture(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    good, calls = Frames.frame, []

    def sometimes(self: Frames) -> dict[str, Any]:
        calls.append(0)
        if len(calls) == 5:
            raise IndexError("a row that has gone")
        return good(self)

    async def watched(server: Any) -> None:
        async with socket(server) as page:
            assert "a row that has gone" in (await until(page, "error"))["text"]
            await until(page, "frame")

    monkeypatch.setattr(Frames, "frame", sometimes)
    with serve(virtual=True, folder=tmp_path) as server:
        ask(lambda: watched(server))


@pytest.mark.slow
def test_one_controls_and_many_watch(server: Any) -> None:
    async def opened() -> None:
        async with (
            socket(server) as first,
            socket(server) as second,
            socket(server, "watch") as third,
        ):
            await until(first, "state", role="control")
            for other in (second, third):
                await until(other, "state", role="watch")
                for message in (
                    {"kind": "change", "name": "law", "value": "tca"},
                    {"kind": "pause"},
                ):
                    await other.send(json.dumps(message))
                    assert "only watches" in (await until(other, "error"))["text"]
            assert server.session.choices.law == "ebac"
            await first.send(json.dumps({"kind": "change", "name": "law", "value": "tca-damped"}))
            await until(second, "state", notice="law = tca-damped: changed while it runs")
            await first.close()
            await until(third, "state", free=False)
            await until(second, "state", free=True)
            await third.send(json.dumps({"kind": "take"}))
            await second.send(json.dumps({"kind": "take"}))
            await until(second, "state", role="control")

    ask(opened)
    assert server.session.choices.law == "tca-damped"
    assert server.session.starts == 1


WRONG = [
    "", "{", "[]", "null", "{}", '{"kind": 1}', '{"kind": "limits"}', '{"kind": "drag"}',
    '{"kind": "drag", "place": [NaN]}', '{"kind": "drag", "place": ["a"]}', '{"kind": "drag", "place": [true]}',
    '{"kind": "change", "name": "law", "value": {}}', '{"kind": "start", "force": true}', "[" * 2000, "x" * 5000,
    b"\x00\xff",
]  # fmt: skip


@pytest.mark.parametrize("raw", WRONG)
def test_a_malformed_message_is_refused(raw: str | bytes) -> None:
    with pytest.raises(MalformedError):
        read(raw)


@pytest.mark.slow
def test_malformed_messages_by_the_thousand_do_not_reach_the_loop(server: Any) -> None:
    async def flood(seed: int) -> None:
        random = np.random.default_rng(seed)
        async with socket(server) as page:
            with contextlib.suppress(ConnectionClosed):
                for k in range(1000):
                    raw = WRONG[k % len(WRONG)] if k % 2 else random.bytes(60).decode("latin-1")
                    await page.send(raw)
                await page.wait_closed()
            assert page.close_code in (1008, 1009)

    run = server.session.run
    for seed in range(3):
        ask(lambda seed=seed: flood(seed))
    assert server.malformed > 200
    assert server.session.run is run
    assert server.session.running
    assert not server.session.fault


def test_a_release_acts_however_many_messages_come_before_it(
    server: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ebac.live.server.MOST_MESSAGES", 5)
    let_go: list[bool] = []
    monkeypatch.setattr(server.session, "let_go", lambda: let_go.append(True))

    async def opened() -> None:
        async with socket(server) as page:
            await until(page, "state", role="control")
            for _ in range(20):
                await page.send('{"kind": "hold"}')
            await page.send('{"kind": "release"}')
            async with asyncio.timeout(5):
                while not let_go:
                    await asyncio.sleep(0.01)

    ask(opened)


def test_values_out_of_range_are_answered_and_change_nothing(server: Any) -> None:
    before = server.session.choices

    async def opened() -> None:
        async with socket(server) as page:
            for message, text in (
                ({"kind": "drag", "place": [1e9, 0]}, "must be 2 numbers in"),
                ({"kind": "drag", "place": [0.0]}, "must be 2 numbers in"),
                ({"kind": "drag", "place": [10**400, 0]}, "must be 2 numbers in"),
                (
                    {"kind": "change", "name": "stiffness", "value": 1e9},
                    "must lie in [100, 50000] N/m",
                ),
                ({"kind": "change", "name": "limits", "value": 9}, "no setting is called 'limits'"),
                ({"kind": "mode", "mode": "fly"}, "there are: press, tap, rest"),
            ):
                await page.send(json.dumps(message))
                assert text in (await until(page, "error"))["text"]

    ask(opened)
    assert server.session.choices == before


@pytest.mark.slow
def test_a_page_that_goes_while_it_drags_leaves_a_hand_that_lets_go(server: Any) -> None:
    async def opened() -> None:
        async with socket(server) as page:
            await until(page, "state", role="control")
            await page.send(json.dumps({"kind": "drag", "place": [0.03, 0.0]}))
            await asyncio.sleep(1.5)
            page.transport.abort()

    def pressed() -> float:
        return abs(float(server.session.run.tail(50).axis("f_meas", 0).mean()))

    ask(opened)
    held = pressed()
    assert held > 4
    time.sleep(0.3)
    assert pressed() == pytest.approx(held, abs=0.5)  # it holds
    time.sleep(1.5)
    assert pressed() < 0.1 * held  # it let go
    assert server.session.running


def test_without_allow_control_nobody_controls_and_the_dead_man_key_ends_with_its_page(
    tmp_path: Path,
) -> None:
    with serve(dead_man=True, folder=tmp_path) as server:

        async def opened() -> None:
            async with socket(server) as page:
                await until(page, "state", running=False)
                await page.send(json.dumps({"kind": "start"}))
                assert "nobody holds the dead-man key" in (await until(page, "error"))["text"]
                await page.send(json.dumps({"kind": "hold"}))
                await page.send(json.dumps({"kind": "start"}))
                for _ in range(15):
                    await page.send(json.dumps({"kind": "hold"}))
                    await asyncio.sleep(0.1)
                assert server.session.running
                page.transport.abort()

        ask(opened)
        gone = time.monotonic()
        while server.session.running:
            assert time.monotonic() - gone < 1.5
            time.sleep(0.01)
        server._pages.control = False  # as hardware without --allow-control

        async def refused() -> None:
            async with socket(server) as page:
                assert (await until(page, "state"))["role"] == "watch"
                await page.send(json.dumps({"kind": "take"}))
                await page.send(json.dumps({"kind": "hold"}))
                assert "only watches" in (await until(page, "error"))["text"]

        ask(refused)
        assert not server.session.running


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "end"),
    [
        (["live"], "Ended; drives without power. Kept: no files."),
        (["gastroscopy", "--live"], "Ended; all of it was simulated. Kept: no files."),
    ],
)
def test_the_command_prints_its_address_and_ends_with_ctrl_c(
    tmp_path: Path, command: list[str], end: str
) -> None:
    words = [sys.executable, "-m", "ebac.cli", *command, "--no-browser", "--json"]
    with subprocess.Popen(
        words,
        cwd=tmp_path,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as run:
        assert run.stdout is not None
        told = json.loads(run.stdout.readline())
        assert status(told["url"]) == 200
        assert status(told["watch_url"]) == 200
        run.send_signal(signal.SIGINT)
        _, said = run.communicate(timeout=30)
    assert run.returncode == 0, said
    assert end in said
    assert not list(tmp_path.iterdir())


def test_an_address_that_cannot_be_is_named_by_its_option() -> None:
    with create_server(("127.0.0.1", 0)) as other:
        port = str(other.getsockname()[1])
        taken = CliRunner().invoke(app, ["live", "--no-browser", "--port", port])
    assert taken.exit_code == 2
    assert f"--port {port}: " in " ".join(taken.stderr.split())
    assert "give another one, or leave it out" in " ".join(taken.stderr.split())
    of_others = CliRunner().invoke(app, ["live", "--no-browser", "--host", "203.0.113.1"])
    assert of_others.exit_code == 2
    assert "--host 203.0.113.1: " in " ".join(of_others.stderr.split())
    assert "give an address of this machine, or leave it out" in " ".join(of_others.stderr.split())
