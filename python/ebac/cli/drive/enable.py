"""`ebac drive enable`, `disable`, `reset-fault`: what moves, or stops moving."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac._util.exception_notes import noted_on
from ebac.cli import output
from ebac.cli.drive import results
from ebac.cli.drive.options import (
    BusOptions,
    Nodes,
    Yes,
    checked,
    drives,
    opened,
    sure,
)

if TYPE_CHECKING:
    from ebac.drives import Drive


def enable(
    where: BusOptions,
    node: Annotated[
        list[int],
        typer.Option("--node", "-n", help="Node id; several separated by commas.", min=1, max=127),
    ],
    mode: Annotated[
        int | None,
        typer.Option(
            help="Mode to set first: 10 cyclic synchronous torque, 4 profile torque.",
            show_default="as applied",
            min=1,
            max=32,
        ),
    ] = None,
    yes: Yes = False,
    as_json: output.AsJson = False,
) -> None:
    """Enable the motors with zero torque. Keep your hands off the device.

    They stay enabled after the command, until `ebac drive disable`. If a motor moves now, a sign is wrong, the
    encoder is wrong or another master commands it: disable it.

    **Examples**

    * `ebac drive enable --node 1 --mode 10 --yes --interface ebac --channel joystick`
    """
    chosen = list(dict.fromkeys(node))
    ids = ", ".join(str(n) for n in chosen)
    sure(f"The motor of node {ids} will be powered, at zero torque. Is the device free?", yes)

    with opened(where) as bus:
        on: list[Drive] = []
        try:
            for n in chosen:
                on.append(checked(bus, n, where))
                on[-1].enable(mode=mode)
        except BaseException as error:
            _off(on, error)
            raise
        rows = [_state(one) for one in on]
    _show_states("drive enable", rows, as_json)


def _off(powered: list[Drive], error: BaseException) -> None:
    """Disable every drive, also when one of them does not obey."""
    for one in powered:
        with noted_on(error, f"and node {one.node} could not be disabled"):
            one.disable()


def disable(
    where: BusOptions,
    node: Nodes = None,
    as_json: output.AsJson = False,
) -> None:
    """Switch off the power of the motors, in any state.

    **Examples**

    * `ebac drive disable --interface ebac --channel joystick`: every drive on the bus
    """
    with opened(where) as bus:
        _each("drive disable", lambda one: one.disable(), drives(bus, node, where), as_json)


def reset_fault(
    where: BusOptions,
    node: Nodes = None,
    as_json: output.AsJson = False,
) -> None:
    """Reset the fault of a drive and check that it is gone. The drive stays disabled.

    **Examples**

    * `ebac drive reset-fault --node 1 --interface ebac --channel joystick`
    """
    with opened(where) as bus:
        _each(
            "drive reset-fault",
            lambda one: one.reset_fault(),
            drives(bus, node, where),
            as_json,
        )


def _each(command: str, act: Callable[[Drive], object], chosen: list[Drive], as_json: bool) -> None:
    """Do something with every drive, also when one of them fails; then report the first failure."""
    from ebac.drives import DriveError

    failures: list[DriveError] = []
    rows = []
    for one in chosen:
        try:
            act(one)
            rows.append(_state(one))
        except DriveError as error:
            failures.append(error)
    if rows and (as_json or not failures):
        _show_states(command, rows, as_json)
    if failures:
        raise failures[0]


def _show_states(command: str, rows: list[dict[str, Any]], as_json: bool) -> None:
    if as_json:
        typer.echo(output.document(command, rows))
    else:
        results.states(rows)


def _state(one: Drive) -> dict[str, Any]:
    return {"node": one.node, "state": one.state.value}
