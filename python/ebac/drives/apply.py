"""Write a plan to a drive, check it, take it back. Killed at any write, a second run repairs it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path

from ebac._util.progress import Progress
from ebac.drives import read_only
from ebac.drives.aborts import READ_ONLY
from ebac.drives.backup import Backups
from ebac.drives.drive import Drive
from ebac.drives.errors import DriveError, NotApplied, NotVerified, Refused
from ebac.drives.network import Node
from ebac.drives.objects import find
from ebac.drives.plan import Change, Plan, differences, plan, read_held
from ebac.drives.setting import Setting
from ebac.drives.settings import Group, Write, writes

#: "save" as 0x1010 takes it (CiA 301).
_SAVE = b"save"

#: How often what a drive holds is read and written again, where one value changes others.
_ROUNDS = 3


@dataclass(frozen=True, kw_only=True)
class Applied:
    """What was done to a drive.

    Parameters
    ----------
    changes : tuple of Change
        What had been different.
    written : tuple of str
        Every SDO download, in order.
    backup : Path or None
        The file that can take it back; None where nothing was written.
    stored : bool
        Whether the drive keeps it in flash.
    """

    changes: tuple[Change, ...]
    written: tuple[str, ...]
    backup: Path | None
    stored: bool = False


def apply(
    drive: Drive,
    node: Node,
    *,
    backups: Backups | None = None,
    store: bool = False,
    progress: Progress = lambda done, total: None,
) -> Applied:
    """Set a drive to its profile.

    In this order: disable, NMT pre-operational, read all, write the backup, write what differs,
    read all again. The drive stays disabled and pre-operational.

    Parameters
    ----------
    drive : Drive
        Which.
    node : Node
        What is wanted.
    backups : Backups, optional
        Where backups lie; default: the user's state folder.
    store : bool
        Whether the drive shall keep it in flash (0x1010).
    progress : callable
        Called after every write.

    Raises
    ------
    NotApplied
        When it stopped half way; the message lists what was written and what was not.
    NotVerified
        When the drive holds something else than was written.
    DriveError
        When it did not begin: nothing was written.
    """
    shelf = backups or Backups()
    drive.disable()
    first = made = plan(drive, node)
    steps = made.writes()
    backup = shelf.keep(drive, made.held) if steps else None
    for _ in range(_ROUNDS):  # a value written may change others
        _carry_out(drive, made.writes(), progress)
        made = plan(drive, node)
        if not made.changes:
            break
        steps += made.writes()
    verify(drive, node)
    if store:
        _store(drive)
    return Applied(
        changes=first.changes,
        written=tuple(str(step) for step in steps),
        backup=backup,
        stored=store,
    )


def verify(drive: Drive, node: Node) -> Plan:
    """Read all of a profile back from a drive. Nothing is written.

    Parameters
    ----------
    drive : Drive
        Which.
    node : Node
        What is wanted.

    Returns
    -------
    Plan
        Without a change.

    Raises
    ------
    NotVerified
        When something differs; the message names it.
    """
    made = plan(drive, node)
    if made.changes:
        raise NotVerified(_not_held(drive.node, made.changes), node=drive.node)
    return made


def restore(
    drive: Drive,
    *,
    backups: Backups | None = None,
    store: bool = False,
    progress: Progress = lambda done, total: None,
) -> Applied:
    """Put back what a drive held before the first `apply` since the last `restore`.

    The drive is disabled first and stays disabled. The backup goes when all of it is back.

    Parameters
    ----------
    drive : Drive
        Which.
    backups : Backups, optional
        Where backups lie; default: the user's state folder.
    store : bool
        Whether the drive shall keep it in flash (0x1010).
    progress : callable
        Called after every write.

    Returns
    -------
    Applied
        What was changed.

    Raises
    ------
    NotApplied, NotVerified, DriveError
        As `apply`; DriveError also when there is no backup of this drive.
    """
    shelf = backups or Backups()
    kept = shelf.load(drive)
    if kept is None:
        raise DriveError(
            f"node {drive.node}: nothing to restore: no backup of this drive in {shelf.folder} "
            "(they go by node id, vendor, product and serial number)",
            node=drive.node,
        )
    drive.disable()
    wanted = backup_groups(kept.held)
    changes, steps = [], []
    for _ in range(_ROUNDS):
        held = read_held(drive, wanted)
        more = [step for group in wanted for step in writes(group, held)]
        if not more:
            break
        changes += differences(drive.node, wanted, held)
        steps += more
        _carry_out(drive, more, progress)
    must = [replace(g, settings=tuple(s for s in g.settings if not s.optional)) for g in wanted]
    left = differences(drive.node, must, read_held(drive, must))
    if left:
        raise NotVerified(_not_held(drive.node, left), node=drive.node)
    if store:
        _store(drive)
    path = shelf.path(drive)
    shelf.drop(drive)
    return Applied(
        changes=tuple(changes),
        written=tuple(str(step) for step in steps),
        backup=path,
        stored=store,
    )


def backup_groups(held: dict[tuple[int, int], bytes]) -> list[Group]:
    """Return what a backup wants back: the PDOs first, so that nothing else is commanded meanwhile."""
    pdos: dict[str, list[Setting]] = {}
    plain: list[Setting] = []
    for key, data in held.items():
        obj = find(key)
        if obj.name == "torque_offset":
            continue  # a torque is never put back
        value = obj.decode(data)
        assert isinstance(value, int)
        setting = Setting(object=obj, value=value, why="as it was before")
        if obj.name.startswith(("rpdo", "tpdo")):
            pdos.setdefault(obj.name.partition("_")[0], []).append(setting)
        else:
            plain.append(setting)
    groups = [Group(name=name, settings=tuple(_used(s)), pdo=True) for name, s in pdos.items()]
    return [*groups, Group(name="objects", settings=tuple(plain))]


def _used(settings: Sequence[Setting]) -> list[Setting]:
    """Mark the entries beyond the count as optional: no PDO carries them, and not every drive takes a 0."""
    counts = [one.value for one in settings if one.object.name.endswith("_count")]
    used = counts[0] if counts else 0
    return [
        replace(one, optional=True)
        if "_entry" in one.object.name and one.object.sub > used
        else one
        for one in settings
    ]


def _carry_out(drive: Drive, steps: Sequence[Write], progress: Progress) -> None:
    """Write all of it; what a drive refuses is tried again after the rest, for as long as that gets on.

    A drive may take a value only once another one fits it: a peak torque under the limit, a rated current that
    it works out itself from motor data still to come.
    """
    done: list[Write] = []

    def write(step: Write) -> None:
        _write(drive, step)
        done.append(step)
        progress(len(done), len(steps))

    try:
        for ordered, part in groupby(steps, key=lambda step: step.ordered):
            left = list(part)
            while left and not ordered:
                left = _passed_over(write, left)
            for step in left:
                write(step)
    except KeyboardInterrupt as interrupt:
        interrupt.add_note(
            f"node {drive.node}: interrupted after {len(done)} of {len(steps)} writes. {_after(drive)}"
        )
        raise
    except DriveError as error:
        raise NotApplied(
            drive.node,
            f"{error}.",
            written=[str(step) for step in done],
            left=[str(step) for step in steps if step not in done],
            after=_after(drive),
        ) from error


def _passed_over(write: Callable[[Write], None], steps: Sequence[Write]) -> list[Write]:
    """Write each, and return those the drive refused; raise the first refusal when it refused all."""
    refused: list[tuple[Write, Refused]] = []
    for step in steps:
        try:
            write(step)
        except Refused as error:
            refused.append((step, error))
    if len(refused) == len(steps):
        raise refused[0][1]
    return [step for step, _ in refused]


def _write(drive: Drive, step: Write) -> None:
    try:
        drive.sdo.download(step.object, step.data)
    except Refused as error:
        if step.optional:
            return
        # Some drives work out rated torque and current from the motor data, and let nobody write them.
        if error.code != READ_ONLY:
            raise
        held = drive.sdo.upload(step.object)
        if held != step.data:
            raise read_only.refused(error, step.object, held=held, wanted=step.data) from error


def _after(drive: Drive) -> str:
    """Leave the drive disabled, and return how sure that is."""
    again = "Run the command again to finish, or `ebac drive restore` to take it back."
    try:
        state = drive.disable()
    except DriveError:
        return (
            "The drive was disabled before the first write; it does not answer now, so look at it "
            f"before you touch the machine. {again}"
        )
    return f"The drive is disabled ({state.value}). {again}"


def _store(drive: Drive) -> None:
    try:
        drive.sdo.download(find("store_all"), _SAVE)
    except Refused as error:
        raise DriveError(
            f"{error}. All was written and verified, but the drive keeps it only until power-off",
            node=drive.node,
        ) from error


def _not_held(node: int, changes: Sequence[Change]) -> str:
    parts = ", ".join(
        f"{one.object} is {one.object.show(one.now)}, not {one.object.show(one.wanted)}"
        for one in changes
    )
    return f"node {node} holds something else: {parts}"
