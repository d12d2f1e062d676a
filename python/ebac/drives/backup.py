"""The backup of a drive: what it held before anything was written, on disk before the first write.

A backup keeps the first value of every object until `restore` has put all of them back. So an `apply`
that was killed and run again, or two of them one after the other, lose nothing.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from ebac._util.atomic_file import write_text
from ebac._util.wrong_calls import plain_constructor
from ebac.drives.drive import Drive
from ebac.drives.errors import DriveError
from ebac.drives.objects import find

#: Identity of a drive (CiA 301, 0x1018).
_IDENTITY = ("vendor_id", "product_code", "serial_number")


@dataclass(frozen=True, kw_only=True)
class Backup:
    """What a drive held.

    Parameters
    ----------
    node : int
        Node id.
    identity : dict
        Vendor, product and serial number.
    held : dict
        Bytes by (index, sub-index).
    """

    node: int
    identity: dict[str, int]
    held: dict[tuple[int, int], bytes]

    @property
    def name(self) -> str:
        """Name of its file."""
        return "-".join(
            [f"node{self.node}", *(f"{self.identity.get(name, 0):08x}" for name in _IDENTITY)]
        )

    def with_more(self, held: Mapping[tuple[int, int], bytes]) -> Self:
        """Return it with the objects it has not yet; those it has keep their first value."""
        return type(self)(node=self.node, identity=self.identity, held={**dict(held), **self.held})

    def to_json(self) -> str:
        """Return it as text, an object a line."""
        objects = [
            {
                "index": f"0x{index:04X}",
                "sub": sub,
                "name": find((index, sub)).name,
                "bytes": d.hex(),
            }
            for (index, sub), d in self.held.items()
        ]
        about: dict[str, Any] = {"node": self.node, "identity": self.identity}
        rows = ",\n    ".join(json.dumps(row) for row in objects)
        return json.dumps(about)[:-1] + f',\n  "objects": [\n    {rows}\n  ]\n}}\n'

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Read it back.

        Raises
        ------
        ValueError
            When it is no backup.
        """
        try:
            found = json.loads(text)
            held = {
                (int(row["index"], 16), int(row["sub"])): bytes.fromhex(row["bytes"])
                for row in found["objects"]
            }
            identity = {name: int(found["identity"][name]) for name in found["identity"]}
            return cls(node=int(found["node"]), identity=identity, held=held)
        except (KeyError, TypeError, ValueError) as error:
            raise ValueError(f"not a backup of a drive ({error!r})") from None


@plain_constructor
class Backups:
    """A folder of backups, one file a drive.

    Parameters
    ----------
    folder : Path, optional
        Default: `ebac/drives` in the user's state folder (XDG_STATE_HOME, or ~/.local/state).
    """

    def __init__(self, folder: str | Path | None = None) -> None:
        self.folder = Path(folder) if folder is not None else state_folder()

    def path(self, drive: Drive) -> Path:
        """Return the file of a drive, by node id and identity."""
        return self.folder / f"{_empty(drive).name}.json"

    def load(self, drive: Drive) -> Backup | None:
        """Return the backup of a drive, None when there is none.

        Raises
        ------
        DriveError
            When the file is no backup.
        """
        path = self.path(drive)
        try:
            return Backup.from_json(path.read_text(encoding="utf-8"))
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            raise DriveError(
                f"node {drive.node}: the backup {path} cannot be read ({error.strerror})",
                node=drive.node,
            ) from error
        except ValueError as error:
            raise DriveError(
                f"node {drive.node}: {path}: {error}; move it away, or mend it", node=drive.node
            ) from None

    def keep(self, drive: Drive, held: Mapping[tuple[int, int], bytes]) -> Path:
        """Write what a drive holds, beside what its backup has already; return the file.

        It is on disk, whole, when this returns.
        """
        backup = (self.load(drive) or _empty(drive)).with_more(held)
        path = self.path(drive)
        try:
            self._write(path, backup.to_json())
        except OSError as error:
            raise DriveError(
                f"node {drive.node}: the backup {path} cannot be written ({error.strerror}); give another "
                "folder with --backup. Nothing was written to the drive",
                node=drive.node,
            ) from error
        return path

    def _write(self, path: Path, text: str) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        write_text(path, text)
        folder = os.open(self.folder, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)

    def drop(self, drive: Drive) -> None:
        """Remove the backup of a drive that holds all of it again."""
        self.path(drive).unlink(missing_ok=True)


def state_folder() -> Path:
    """Return the default folder of backups."""
    base = os.environ.get("XDG_STATE_HOME")
    return (Path(base) if base else Path.home() / ".local" / "state") / "ebac" / "drives"


def _empty(drive: Drive) -> Backup:
    found = {name: drive.look(name) for name in _IDENTITY}
    identity = {name: value for name, value in found.items() if isinstance(value, int)}
    return Backup(node=drive.node, identity=identity, held={})
