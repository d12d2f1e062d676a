"""Power to the drives, and a loop that has them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from ebac._core import RunSetup
from ebac.hardware import drive_setup
from ebac.hardware.axis_positions import AxisPosition, check_outside, check_workspace, positions_of
from ebac.hardware.interrupts import Interrupts
from ebac.hardware.run import Run
from ebac.hardware.run_log import discard_log
from ebac.hardware.run_setup import started
from ebac.logs.about import CONFIGURATION_FILE, POSITIONS_FILE, SIMULATED_FILE
from ebac.logs.writer import new_log

if TYPE_CHECKING:
    from ebac.drives import Node
    from ebac.hardware.backends import Backend
    from ebac.hardware.configuration import Configuration
    from ebac.hardware.held import Held
    from ebac.laws import CoreLaw
    from ebac.scenario import Scenario


def power_up(
    known: Configuration,
    backend: Backend,
    nodes: Sequence[Node],
    interrupts: Interrupts,
    held: Held,
    *,
    law: CoreLaw,
    scenario: Scenario,
    setup: RunSetup,
    log: Path | None,
    detached: bool,
) -> Run:
    """Give the drives power and start the loop, recorded to `log`; whatever fails, no drive keeps power."""
    positions: list[AxisPosition] = []

    def check(counts: list[int]) -> None:
        positions[:] = positions_of(known, counts)
        check_workspace(known, positions)
        check_outside(known, positions, scenario.environment)

    def power_off() -> list[str]:
        return drive_setup.power_off(backend, nodes)

    file = None if log is None else new_log(log)  # before there is power
    with ExitStack() as undo:  # from the last to the first, each whatever the others raise
        undo.callback(discard_log, file, log)
        drive_setup.start(backend, nodes, check)
        undo.callback(interrupts.forget)
        undo.callback(power_off)
        undo.callback(interrupts.ending)
        interrupts.moving()
        running = started(law, backend, setup)
        run = held.run = Run(
            running,
            law=law,
            scenario=scenario,
            interrupts=interrupts,
            power_off=power_off,
            grants=backend.grants,
            hand=backend.aim is not None,
            detached=detached,
            positions=positions,
        )
        undo.pop_all()
    try:
        if log is not None:
            rows = [one.row() for one in positions]
            files = {CONFIGURATION_FILE: known.text, POSITIONS_FILE: json.dumps(rows)}
            if backend.aim is not None:  # a simulated hand: drives and device are simulated too
                files[SIMULATED_FILE] = f"{backend.about}\n"
            run.record(log, files=files, sync=known.sync, file=file)
        held.last_to_register()
    except BaseException:
        run.end()
        raise
    return run
