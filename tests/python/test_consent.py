"""A hand that consents after a lost link: not by what it typed before it was asked, and not by itself."""

import os
import socket
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

import ebac
from ebac import Hand, MinimumJerk, Scenario, logs
from ebac.cli import app
from ebac.cli.drive.options import sure
from ebac.cli.gastroscopy.drives import _notifier
from ebac.cli.gastroscopy.line_printer import LinePrinter
from ebac.cli.gastroscopy.side_table import show
from ebac.cli.run.confirm import can_ask
from ebac.cli.teleop.consent import Consent
from ebac.gastroscope.far_side import LinkEvent
from ebac.gastroscope.on_drives import configuration, run_master, run_slave
from ebac.hardware import OpenDevice
from ebac.teleop import Link, Packet, processes, scheme

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")


@pytest.fixture
def keyboard(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    end, keys = os.pipe()
    with os.fdopen(end) as typed:
        monkeypatch.setattr(sys, "stdin", typed)
        yield keys
    os.close(keys)


def test_enter_before_the_question_is_no_consent(keyboard: int) -> None:
    consent = Consent()
    os.write(keyboard, b"\n\n")
    assert not consent.given()
    consent.ask()
    assert not consent.given()
    os.write(keyboard, b"\n")
    assert consent.given()
    assert not consent.given()


def test_enter_after_the_link_has_gone_again_is_no_consent(keyboard: int) -> None:
    consent = Consent()
    consent.ask()
    consent.withdraw()
    os.write(keyboard, b"\n")
    assert not consent.given()
    consent.ask()
    assert not consent.given()


def test_the_end_of_standard_input_is_no_consent(monkeypatch: pytest.MonkeyPatch) -> None:
    with Path(os.devnull).open(encoding="utf-8") as nobody:
        monkeypatch.setattr(sys, "stdin", nobody)
        consent = Consent()
        consent.ask()
        assert not consent.given()


def test_without_a_standard_input_nobody_consents_and_that_is_shown(
    monkeypatch: pytest.MonkeyPatch, keyboard: int
) -> None:
    heard: list[str] = []
    printer: Any = SimpleNamespace(say=heard.append)
    notify = _notifier("master", printer, consent := Consent())
    back = LinkEvent(t=1.0, what="back", text="the link is back")
    notify(back)
    assert "press Enter to go on" in heard[-1]
    for none in (None, Path(os.devnull).open(encoding="utf-8")):  # noqa: SIM115
        monkeypatch.setattr(sys, "stdin", none)
        if none is not None:
            none.close()
        notify(back)
        assert not consent.given()
        assert "nobody can consent, as standard input is closed: end this" in heard[-1]


def test_a_command_without_a_standard_input_refuses_what_it_has_to_ask(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(typer.Exit):
        sure("Are the motors free?", yes=False)
    assert "Nobody is here to ask: add --yes" in " ".join(capsys.readouterr().err.split())
    with pytest.raises(typer.Exit):
        can_ask(configuration("master"), yes=False)


def test_a_stopped_terminal_holds_up_nobody() -> None:
    """A pipe that nobody reads takes 64 kB; more is said later, and who says it goes on."""
    end, full = os.pipe()
    with os.fdopen(full, "w") as terminal:
        printer = LinePrinter(terminal)
        began = time.monotonic()
        for _ in range(3):
            printer.say("x" * 100_000)
        printer.close()
        assert time.monotonic() - began < 30  # it would wait for ever
        heard = 0
        while heard < 300_003:
            heard += len(os.read(end, 65536))
    os.close(end)


def test_no_hand_is_simulated_on_real_drives() -> None:
    with pytest.raises(ValueError, match=r"consent_after = 1 s: only a simulated hand"):
        run_master(configuration("master"), peer=("127.0.0.1", 49201), consent_after=1.0)
    words = ["gastroscopy", "master", "mine.toml", "--consent-after", "1"]
    ended = CliRunner().invoke(app, words)
    assert ended.exit_code == 2
    assert "--consent-after 1: only with --simulated" in ended.stderr


def test_another_machine_is_not_asked_from_a_loopback_address() -> None:
    peer = ("192.0.2.1", 49201)
    with pytest.raises(ValueError, match=r"host = 127.0.0.1: from there nothing reaches the slave"):
        run_master(peer=peer, simulate=True)
    with pytest.raises(ValueError, match="host = localhost: from there nothing"):
        processes.Network(Link(), Link(), host="localhost", port=0, slave=peer)
    law = ebac.laws.design("direct", Scenario().device, Scenario().known_timing)
    with pytest.raises(ValueError, match="host = 127"):
        processes.Master(
            Scenario(), law, scheme("position-force"), host="127.0.0.1", port=0, peer=peer
        )


@LINUX
@pytest.mark.real_time
@pytest.mark.slow
def test_a_side_says_that_what_comes_is_of_another_protocol() -> None:
    ours = Packet().encode()[2]
    older = bytes([*b"ET", ours - 1, 0, *bytes(52)])

    def ready(port: int) -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            for _ in range(20):
                other.sendto(older, ("127.0.0.1", port))

    found = run_slave(simulate=True, seconds=1.0, ready=ready)
    assert [one.what for one in found.events] == ["refused"]
    assert f"version {ours}" in found.events[0].text


class NoError(Exception):
    """What somebody answers who says no."""


def test_no_drive_of_the_slave_has_power_before_both_pairs_are_confirmed(tmp_path: Path) -> None:
    asked: list[OpenDevice] = []

    def confirm(device: OpenDevice) -> None:
        asked.append(device)
        if len(asked) == 2:
            raise NoError

    with pytest.raises(NoError):
        run_slave(simulate=True, log=tmp_path / "slave.mcap", confirm=confirm)
    assert len(asked) == 2
    assert asked[0].report is None  # it was never run
    assert not list(tmp_path.iterdir())


@LINUX
@pytest.mark.slow
@pytest.mark.weekly
@pytest.mark.real_time
def test_what_a_waiting_master_asks_is_not_made_up_for(tmp_path: Path) -> None:
    """The lever is out before the slave starts: insertion begins with the lever's speed, not with a run."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    hand = Hand(path=[MinimumJerk(target=one, at=0.3, duration=0.3) for one in (0, 0, 0.008)])
    known = configuration("master").replace(hand=hand)
    master = threading.Thread(
        target=lambda: run_master(known, peer=("127.0.0.1", port), simulate=True, seconds=4.0)
    )
    master.start()
    time.sleep(1.0)
    slave = run_slave(simulate=True, port=port, seconds=30, log=tmp_path / "slave.mcap")
    master.join()
    log = logs.load(slave.logs[0])
    t, x = log["t"], log.axis("x", 0)
    speed = (x[50:] - x[:-50]) / (t[50:] - t[:-50])
    assert x[-1] > 0.01
    assert speed.max() < 0.03  # m/s; the lever asks 0.013, the slave may 0.08


def test_a_run_on_real_drives_is_not_called_simulated(capsys: pytest.CaptureFixture[str]) -> None:
    show({}, [], simulated=False)
    assert "simulated" not in capsys.readouterr().out


@LINUX
def test_pairs_of_different_sample_times_are_refused_before_power() -> None:
    feed = configuration("feed")
    slower = feed.replace(timing=feed.timing.replace(dt=2e-3))
    with pytest.raises(ValueError, match=r"timing.dt = 0.002 s and 0.001 s: must be the same"):
        run_slave(slower, simulate=True)
