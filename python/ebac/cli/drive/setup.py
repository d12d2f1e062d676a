"""`ebac drive apply`, `restore`: write a profile to drives, and take it back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import typer

from ebac.cli import output
from ebac.cli.drive import results
from ebac.cli.drive.options import (
    BackupFolder,
    BusOptions,
    Nodes,
    ProfileName,
    ProfileNodes,
    Store,
    Yes,
    about,
    checked,
    drives,
    network_of,
    opened,
    sure,
)

if TYPE_CHECKING:
    from ebac._util.progress import Progress
    from ebac.drives import Applied, Backups, Drive, Node

    Row = dict[str, Any]
    Work = Callable[[Progress], Applied]


def apply(
    where: BusOptions,
    profile: ProfileName = "joystick",
    node: ProfileNodes = None,
    yes: Yes = False,
    store: Store = False,
    backup: BackupFolder = None,
    as_json: output.AsJson = False,
) -> None:
    """Set the drives to a profile: disable, back up, write, read back. They stay disabled.

    Without `--yes` the plan is shown and confirmation is asked for, unless nothing is to be written and no drive has
    power. After an interruption the same command finishes the work, and `ebac drive restore` undoes it.

    **Examples**

    * `ebac drive apply joystick --yes --interface ebac --channel joystick`

    * `ebac drive apply joystick --yes --store --interface ebac --channel joystick`: kept without power
    """
    from ebac import drives as library

    network = network_of(profile, node, where)
    with opened(where) as bus:
        pairs = [(checked(bus, n.id, where, n.sheet), n) for n in network.nodes]
        found = [change for one, n in pairs for change in library.plan(one, n).changes]
        if not as_json:
            results.changes(found, "The drives hold all of it: nothing will change.")
            results.load(network)
        if question := _question(pairs, changes=bool(found), store=store):
            sure(question, yes)
        shelf = library.Backups(backup)
        work = [(one, partial(_apply, one, n, shelf, store)) for one, n in pairs]
        rows, nodes = _carried_out(work, as_json)
    if as_json:
        typer.echo(output.document("drive apply", rows, **about(network), nodes=nodes))


def restore(
    where: BusOptions,
    node: Nodes = None,
    yes: Yes = False,
    store: Store = False,
    backup: BackupFolder = None,
    as_json: output.AsJson = False,
) -> None:
    """Restore the settings that the drives had before the first `apply`. They stay disabled.

    **Examples**, on a device: needs a backup that `ebac drive apply` made

    * `ebac drive restore --node 1 --yes`
    """
    from ebac import drives as library

    with opened(where) as bus:
        chosen = drives(bus, node, where)
        shelf = library.Backups(backup)
        if not node:
            chosen = [one for one in chosen if shelf.load(one) is not None]
        if not chosen:
            raise library.DriveError(f"nothing to restore: no backup in {shelf.folder}")
        ids = ", ".join(str(one.node) for one in chosen)
        sure(f"Disable node {ids} and put all back?", yes)
        work = [(one, partial(_restore, one, shelf, store)) for one in chosen]
        rows, nodes = _carried_out(work, as_json)
    if as_json:
        typer.echo(output.document("drive restore", rows, nodes=nodes))


def _question(pairs: Sequence[tuple[Drive, Node]], *, changes: bool, store: bool) -> str:
    """Return what `apply` asks: only what it does; "" where that is nothing that anybody would notice."""
    concerned = [one.node for one, _ in pairs if changes or store or one.state.powered]
    if not concerned:
        return ""
    ids = f"{'node' if len(concerned) == 1 else 'nodes'} {', '.join(map(str, concerned))}"
    if changes:
        return f"Disable {ids} and write this{' and store it' if store else ''}?"
    return (
        f"Disable {ids} and store what is held?" if store else f"Disable {ids}? Nothing is written."
    )


def _apply(one: Drive, node: Node, shelf: Backups, store: bool, step: Progress) -> Applied:
    from ebac.drives import apply as write

    return write(one, node, backups=shelf, store=store, progress=step)


def _restore(one: Drive, shelf: Backups, store: bool, step: Progress) -> Applied:
    from ebac.drives import restore as put_back

    return put_back(one, backups=shelf, store=store, progress=step)


def _carried_out(work: Sequence[tuple[Drive, Work]], as_json: bool) -> tuple[list[Row], list[Row]]:
    """Do the work of every drive with a bar, say what was done, and return changes and nodes as plain rows."""
    changes, nodes = [], []
    for one, carry_out in work:
        with output.counting(f"node {one.node}", quiet=as_json) as step:
            done = carry_out(step)
        if not as_json:
            _say_done(one, done)
        changes += [change.row() for change in done.changes]
        nodes.append(
            {
                "node": one.node,
                "written": len(done.written),
                "backup": None if done.backup is None else str(done.backup),
                "stored": done.stored,
                "state": one.state.value,
            }
        )
    return changes, nodes


def _say_done(one: Drive, done: Applied) -> None:
    kept = " The drive keeps it without power." if done.stored else ""
    if not done.written:
        output.say(f"Node {one.node}: holds all of it already, nothing was written.{kept}")
        return
    objects, writes = len(done.changes), len(done.written)
    more = (
        " (a PDO that changes is switched off, written whole and switched on)"
        if writes > objects
        else ""
    )
    output.say(
        f"Node {one.node}: {output.plural(objects, 'object')} in {output.plural(writes, 'write')}{more}, read back and "
        f"right. It is disabled, NMT pre-operational.{kept}"
    )
    if done.backup is not None and done.backup.exists():
        output.say(f"Backup: {done.backup}", style="dim")
    else:
        output.say(f"Its backup has served and is gone: {done.backup}", style="dim")
