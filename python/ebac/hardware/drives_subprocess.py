"""Simulated drives in another process, on a CAN interface of the kernel."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from ebac._core import Free
from ebac._util.foreign_worlds import foreign
from ebac.drives.errors import BusError

if TYPE_CHECKING:
    from ebac._core import Grant, SharedHandTarget
    from ebac.hardware.configuration import Configuration
    from ebac.scenario import Scenario
    from ebac.sensor import SensorConfig

#: How long it may take to put its drives on a bus [s].
_START = 60.0


@contextmanager
def in_a_process(
    channel: str,
    configuration: Configuration,
    scenario: Scenario,
    first: int,
    aim: SharedHandTarget,
) -> Iterator[tuple[SensorConfig | None, list[Grant]]]:
    """Let `ebac drive simulate` put drives on `channel`; give where their sensor is, and what its threads were granted.

    Raises
    ------
    BusError
        When it cannot.
    """
    from ebac._core import Grant

    sensor, loop = configuration.sensor, configuration.realtime
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scenario.toml"
        _without_engine(scenario).save(file)
        command = [sys.executable, "-m", "ebac.cli", "drive", "simulate"]
        command += ["--channel", channel, "--scenario", str(file), "--first", str(first)]
        command += ["--realtime", configuration.mode, "--beside", str(loop.priority)]
        command += ["--wait-for-power", "--until-eof", "--aim", str(aim.descriptor)]
        for zero in configuration.counts_of_simulated_drives:
            command += ["--zero", str(zero)]
        if not loop.lock_memory:
            command += ["--no-lock-memory"]
        if sensor is not None:
            counts = [f"{sensor.counts_per_force!r}", f"{sensor.counts_per_torque!r}"]
            command += ["--sensor", "--sensor-counts", *counts]
        with (
            subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                pass_fds=[aim.descriptor],
                start_new_session=True,  # Ctrl-C is for the loop: its drives must be there until it has stopped
            ) as process
        ):
            try:
                assert process.stdout is not None
                said, granted = process.stdout.readline(), process.stdout.readline()
                if not granted:
                    _, output = process.communicate(timeout=_START)
                    raise BusError(f"simulated drives on {channel}: {' '.join(output.split())}")
                port = re.search(r"force sensor at 127\.0\.0\.1:(\d+)", said)
                where = _emulated(sensor, int(port[1])) if sensor and port else None
                yield where, [Grant(**one) for one in json.loads(granted)]
            finally:
                assert process.stdin is not None
                process.stdin.close()
                try:
                    process.wait(timeout=5)
                except subprocess.TimeoutExpired:
                    process.kill()


def _without_engine(scenario: Scenario) -> Scenario:
    """Return the scenario without a world that no file can hold: the drives meet none."""
    world = foreign(scenario.environment)
    return scenario if world is None or world.has_text else scenario.replace(environment=Free())


def _emulated(known: SensorConfig, port: int) -> SensorConfig:
    """Return where a simulated sensor in another process is; it sits straight in the handle."""
    straight = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    return known.replace(
        host="127.0.0.1", port=port, rotation=straight, sign=1, model="net-ft", bias=(0.0,) * 6
    )
