"""Errors of drives; each message contains the remedy."""

from __future__ import annotations

from collections.abc import Sequence

from ebac.drives import aborts
from ebac.drives.objects import Object
from ebac.drives.state import State


class DriveError(Exception):
    """Something went wrong with a drive or its bus.

    Parameters
    ----------
    message : str
        What happened and what to do.
    node : int or None
        Node id of the drive, 1 to 127; None where no single drive is meant.
    """

    def __init__(self, message: str, *, node: int | None = None) -> None:
        super().__init__(message)
        self.node = node


class BusError(DriveError):
    """The bus cannot be opened, or takes no frame."""


class NoCan(BusError):
    """The machine has no such CAN interface; simulated drives need none."""


class NoAnswer(DriveError):
    """A drive did not answer in time.

    The message names the node and the object, the traffic on the bus meanwhile, and what to check.
    """

    def __init__(
        self, node: int, what: str, seconds: float, *, traffic: str, check: Sequence[str]
    ) -> None:
        checks = "; ".join(f"{i}. {text}" for i, text in enumerate(check, start=1))
        super().__init__(
            f"node {node} did not answer within {1e3 * seconds:.0f} ms ({what}). "
            f"On the bus meanwhile: {traffic}. Check: {checks}",
            node=node,
        )
        self.what, self.seconds, self.traffic = what, seconds, traffic

    def beside(self, others: Sequence[int]) -> NoAnswer:
        """Return the same error on a bus on which other nodes answer when they are asked."""
        assert self.node is not None
        names = ", ".join(str(node) for node in others)
        who = f"node {names} answers" if len(others) == 1 else f"nodes {names} answer"
        check = (
            f"the node id: {who}, node {self.node} does not; change the id of the drive or that of the network file",
            f"power of drive {self.node}, its bit rate and its CAN connector",
        )
        traffic = f"nothing, but {who} when asked"
        return NoAnswer(self.node, self.what, self.seconds, traffic=traffic, check=check)


class Refused(DriveError):
    """A drive refused to read or write an object: an SDO abort (CiA 301).

    `remedy` replaces what is to be done about the abort code.
    """

    def __init__(self, node: int, obj: Object, doing: str, code: int, remedy: str = "") -> None:
        super().__init__(
            f"node {node} refused {doing} {obj}: {aborts.meaning(code)} (0x{code:08X}); "
            f"{remedy or aborts.remedy(code)}",
            node=node,
        )
        self.object = obj
        self.code = code

    @property
    def absent(self) -> bool:
        """Whether the drive has no such object."""
        return self.code in aborts.ABSENT


class Missing(Refused):
    """A drive has not all objects that a profile sets; the message lists every one, with the key that wants it.

    Parameters
    ----------
    node : int
        Node id.
    lacking : sequence of (Object, str, int)
        Objects, the key of each, and the abort code the drive answered with.
    """

    def __init__(self, node: int, lacking: Sequence[tuple[Object, str, int]]) -> None:
        DriveError.__init__(
            self, f"node {node} {lacks([(o, k) for o, k, _ in lacking])}", node=node
        )
        self.object, _, self.code = lacking[0]
        self.lacking = tuple(lacking)


def lacks(lacking: Sequence[tuple[Object, str]]) -> str:
    """Return in words what a drive has not, and what to do about it."""
    count = f"{len(lacking)} objects" if len(lacking) > 1 else "1 object"
    listed = ", ".join(
        f"{obj.where} {obj.name}" + (f" (key {key})" if key else "") for obj, key in lacking
    )
    return (
        f"lacks {count} of the profile. Is this the right profile for the drive? `ebac drive profile` lists those that "
        f"come with ebac, and for another drive prints generic-cia402 to start from. It lacks: {listed}. Leave the key "
        "out, or name it under `without` where it only scales others; a maker's own object goes under [objects]"
    )


def says_absent(obj: Object, key: str) -> str:
    """Return in words that a drive has what a profile says it has not."""
    return (
        f"has {obj}, and the profile's `without` says that it does not ({key}): its torques would mean something else. "
        "Is this the right profile for the drive? Take the key out of `without`, or set the object under [objects]"
    )


class WrongAnswer(DriveError):
    """A drive answered something else than was asked, or does not carry out a command."""


class WrongState(DriveError):
    """A drive did not reach the state asked for."""

    def __init__(self, node: int, wanted: str, found: State, hint: str) -> None:
        super().__init__(f"node {node} is {found.value!r}, not {wanted}: {hint}", node=node)
        self.found = found


class DriveFault(DriveError):
    """A drive is in fault.

    Parameters
    ----------
    node : int
        Node id.
    code : int or None
        Object 0x603F, None where it cannot be read.
    emergencies : sequence of str
        The emergencies received, oldest first.
    latched : sequence of str
        Latched faults of a Copley drive by name.
    doing : str
        What was being done.
    """

    def __init__(
        self,
        node: int,
        *,
        code: int | None,
        emergencies: Sequence[str],
        latched: Sequence[str],
        doing: str,
    ) -> None:
        from ebac.drives.faults import emergency

        parts = []
        if code:
            parts.append(f"error code 0x{code:04X}, {emergency(code)}")
        if latched:
            parts.append(f"latched: {', '.join(latched)}")
        if emergencies:
            parts.append(f"emergencies: {'; '.join(emergencies)}")
        reason = ". ".join(parts) or "it gives no reason"
        super().__init__(
            f"node {node} is in fault while {doing}: {reason}. Remove the cause, then "
            f"`ebac drive reset-fault --node {node}`",
            node=node,
        )
        self.code = code
        self.emergencies = tuple(emergencies)
        self.latched = tuple(latched)


class NotApplied(DriveError):
    """A configuration stopped half way. The drive is disabled unless the message states otherwise.

    `written` and `left` name what was written and what was not, in order.
    """

    def __init__(
        self, node: int, why: str, *, written: Sequence[str], left: Sequence[str], after: str
    ) -> None:
        super().__init__(
            f"node {node}: stopped after {len(written)} of {len(written) + len(left)} writes: {why} "
            f"{after} Written: {', '.join(written) or 'nothing'}. "
            f"Not written: {', '.join(left) or 'nothing'}",
            node=node,
        )
        self.written = tuple(written)
        self.left = tuple(left)


class NotVerified(DriveError):
    """A drive does not hold what was written or wanted."""


class ProfileError(ValueError):
    """A profile is not valid; the message names file, line, key, value, range, remedy."""
