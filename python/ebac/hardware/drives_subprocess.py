"""Simulated drives in another process, on a CAN interface of the kernel."""

from __future__ import annotations

import json
import re
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from ebac._core import Free
from ebac._util.child_processes import first_lines, started, text
from ebac._util.foreign_worlds import foreign
from ebac.drives.errors import BusError
from ebac.hardware.wiring import wiring_of

if TYPE_CHECKING:
    from ebac._core import Grant, SharedHandTarget
    from ebac.hardware.configuration import Configuration
    from ebac.scenario import Scenario
    from ebac.sensor import SensorConfig

#: How long it may take to put its drives on a bus [s]; an emulated core is slow.
_START = 180.0


@contextmanager
def in_a_process(
    channel: str,
    configuration: Configuration,
    scenario: Scenario,
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
        command = ["drive", "simulate"]
        wiring = Path(folder) / "wiring.json"
        wiring.write_text(json.dumps(wiring_of(configuration)), encoding="utf-8")
        command += ["--channel", channel, "--scenario", str(file), "--wiring", str(wiring)]
        command += ["--realtime", configuration.mode, "--beside", str(loop.priority)]
        command += ["--wait-for-power", "--until-eof", "--aim", str(aim.descriptor)]
        if not loop.lock_memory:
            command += ["--no-lock-memory"]
        if sensor is not None:
            counts = [f"{sensor.counts_per_force!r}", f"{sensor.counts_per_torque!r}"]
            command += ["--sensor", "--sensor-counts", *counts]
        with (
            started(
                command,
                stdin=subprocess.PIPE,
                pass_fds=[aim.descriptor],
                start_new_session=True,  # Ctrl-C is for the loop: its drives must be there until it has stopped
            ) as child
        ):
            try:
                lines = first_lines(child, 2, _START)
                if len(lines) < 2:
                    message = text(child.err).split()
                    if child.process.poll() is None:
                        message = [f"did not start within {_START:g} s", *message]
                    raise BusError(f"simulated drives on {channel}: {' '.join(message)}")
                said, granted = lines
                port = re.search(r"force sensor at 127\.0\.0\.1:(\d+)", said)
                where = _emulated(sensor, int(port[1])) if sensor and port else None
                yield where, [Grant(**one) for one in json.loads(granted)]
            finally:
                assert child.process.stdin is not None
                child.process.stdin.close()
                with suppress(subprocess.TimeoutExpired):
                    child.process.wait(timeout=5)


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
