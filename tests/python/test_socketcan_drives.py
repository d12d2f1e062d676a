"""Drives in another process, on the virtual interface that EBAC_CAN names: `.ci/socketcan/run` gives one.

Set up by `ebac drive`, run by the C++ device of the loop (`socketcan_drives_test`), put back, stopped.
"""

import json
import os
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from forked_program import ForkedProgram
from typer.testing import CliRunner

from ebac.cli import app
from ebac.drives.profile import read_source

INTERFACE = os.environ.get("EBAC_CAN", "")
PROGRAM = os.environ.get("EBAC_KERNEL_TESTS", "kernel_tests")

pytestmark = pytest.mark.skipif(
    not INTERFACE, reason="EBAC_CAN names no virtual CAN interface to test on"
)

#: A machine emulated, with one core for the loop and the drives, is late now and then by more than 20 periods.
PATIENT = """
[[node]]
id = 1
profile = "patient-drive.toml"
sync.period = 1.0

[[node]]
id = 2
profile = "patient-drive.toml"
sync.period = 1.0
"""


@pytest.fixture
def drives() -> Iterator[ForkedProgram]:
    with ForkedProgram("drive", "simulate", "--channel", INTERFACE) as served:
        try:
            assert "Simulated drives, nodes 1, 2" in served.stdout.readline()
            yield served
        finally:
            served.kill()


def drive(*words: str, code: int = 0) -> Any:
    where = ["--interface", "socketcan", "--channel", INTERFACE, "--timeout", "5", "--json"]
    result = CliRunner().invoke(app, ["drive", *words, *where])
    assert result.exit_code == code, result.output
    return json.loads(result.stdout)["rows"] if code == 0 else []


def test_configure_enable_run_stop(
    drives: ForkedProgram, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    profile = tmp_path / "patient.toml"
    profile.write_text(PATIENT, encoding="utf-8")
    shipped = read_source("copley-accelnet").text
    assert "event = 0.005" in shipped
    patient = shipped.replace("event = 0.005", "event = 0.4")
    (tmp_path / "patient-drive.toml").write_text(patient, encoding="utf-8")
    backup = ["--backup", str(tmp_path / "backups"), "--yes"]
    assert [row["node"] for row in drive("scan")] == [1, 2]
    assert len(drive("apply", str(profile), *backup)) > 20
    assert drive("verify", str(profile)) == []

    run = subprocess.run(
        [PROGRAM, "--gtest_filter=SocketCanDrives.*"],
        env=os.environ | {"EBAC_CAN_DRIVES": INTERFACE},
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    told = [line for line in run.stdout.splitlines() if "ticks of 1 ms" in line]
    assert told, run.stdout
    with capsys.disabled():
        print("\n" + told[0])

    assert {row["state"] for row in drive("scan")} == {"switch on disabled"}
    assert drive("restore", *backup)
    assert not drive("restore", *backup, code=1)
    drives.send_signal(signal.SIGTERM)
    assert drives.wait(30) == 0
    assert "Stopped:" in drives.stdout.read()
