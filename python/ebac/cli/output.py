"""What every command shares: tables and JSON on stdout, progress and errors on stderr."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn, TypeAlias

import typer

from ebac._util.plural import plural as plural
from ebac._util.row_files import csv_table as csv_table
from ebac._util.row_files import document as document
from ebac.cli.tables import filled as filled
from ebac.cli.tables import show as show
from ebac.cli.tables import table as table

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress, ProgressColumn

#: Exit codes: the input was bad; the work itself failed; it was done, but parts of the input are damaged.
DAMAGED = 3
BAD_INPUT = 2
FAILED = 1

AsJson: TypeAlias = Annotated[
    bool, typer.Option("--json", help="Print one JSON document in SI units, and nothing else.")
]


def console(*, stderr: bool = False) -> Console:
    """Return where people read."""
    from rich.console import Console

    return Console(stderr=stderr, highlight=False, emoji=False)


def say(text: str = "", *, style: str = "") -> None:
    """Print a line for people, wrapped between words."""
    console().print(text, style=style, markup=False)


def fail(message: str, *, code: int = BAD_INPUT) -> NoReturn:
    """End the command with one sentence on stderr and nothing else."""
    console(stderr=True).print(f"[bold red]Error:[/] {_plain(message)}", soft_wrap=True)
    raise typer.Exit(code)


def note(message: str) -> None:
    """Print one sentence on stderr that the user should know, and go on."""
    console(stderr=True).print(f"[bold]Note:[/] {_plain(message)}.", soft_wrap=True)


def _plain(text: str) -> str:
    from rich.markup import escape

    return escape(" ".join(text.split()))


#: Errors of a disk that takes no more.
_FULL = (errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC))


@contextmanager
def refusing(out: Path | None = None) -> Iterator[None]:
    """Turn what the library says about bad input, or about the folder `out`, into the end of the command."""
    try:
        yield
    except OSError as error:
        file = None if error.filename is None else Path(str(error.filename))
        if file and out and (file.is_relative_to(out) or out.is_relative_to(file)):
            cannot_write(f"--out {out}", error, "folder")
        if file and isinstance(error, FileNotFoundError):
            fail(_missing(file))
        if file is None and error.errno and error.strerror != os.strerror(error.errno):
            fail(str(error.strerror))  # a sentence of the library, as of a socket
        verb = "written" if error.errno in _FULL else "read"
        where = f"{file}: " if file else ""
        fail(f"{where}cannot be {verb} ({error.strerror or error})")
    except ImportError as error:  # of an extra; any other is a mistake of ours
        if "pip install" not in str(error):
            raise
        fail(str(error))
    except (KeyError, TypeError, ValueError) as error:
        from ebac.cli.by_option import in_options

        fail(in_options(str(error.args[0]) if error.args else str(error)))


def _missing(path: Path) -> str:
    """Return what is not there: the file, or the folder it should be in."""
    if not path.parent.is_dir():
        return f"{path.parent}: there is no such folder"
    return f"{path}: there is no such {'file' if path.suffix else 'file or folder'}"


@contextmanager
def results(out: Path | None) -> Iterator[Path | None]:
    """Give a draft of the folder `out`, None for none; one that cannot be written ends all."""
    from ebac._util.atomic_folder import filled

    if out is None:
        yield None
        return
    with writing(f"--out {out}", "folder"), filled(out) as draft:
        yield draft


@contextmanager
def writing(where: str, kind: str = "file") -> Iterator[None]:
    """End the command when a file or folder cannot be written; `where` is its option and path."""
    try:
        yield
    except OSError as error:
        cannot_write(where, error, kind)


def cannot_write(where: str, error: OSError, kind: str = "file") -> NoReturn:
    """End the command with what cannot be written, why, and the remedy; `kind` is file or folder."""
    if kind == "folder" and isinstance(error, (FileExistsError, NotADirectoryError)):
        fail(f"{where}: is a file or lies inside one; give the name of a folder")
    fail(f"{where}: cannot be written ({error.strerror or error}); give another {kind}")


def toml(**tables: Any) -> str:
    """Return parts of a scenario as its file has them: by name, SI units."""
    import tomli_w

    from ebac._util.serialisation import to_document

    return tomli_w.dumps({name: to_document(part) for name, part in tables.items()})


def list_files(out: Path, names: Sequence[str]) -> None:
    """Print the folder that was written, on a line of its own, its files, and what `--resume` continues from."""
    say("\nWritten to:", style="bold")
    path(f"{out}/")
    indented(", ".join(names))
    kept = sorted(f"{one.parent.name}/" for one in out.glob("sweep*/sweep.json"))
    if kept:
        indented(f"{', '.join(kept)}: every run, from which --resume continues")


def path(name: str | Path) -> None:
    """Print a path on a line of its own, which no width breaks, so that it can be copied."""
    console().print(str(name), soft_wrap=True, markup=False)


def words(given: Iterable[str] | None) -> list[str]:
    """Return the words of lists separated by commas, each once."""
    parts = (part.strip() for text in given or () for part in text.split(","))
    return list(dict.fromkeys(part for part in parts if part))


def indented(text: str) -> None:
    """Print text for people, set in from the left."""
    from rich.padding import Padding
    from rich.text import Text

    console().print(Padding(Text(text), (0, 0, 0, 2)))


@contextmanager
def progress(total: int, *, quiet: bool) -> Iterator[Callable[[str], None]]:
    """Give a function that names the next step; the bar is on stderr and vanishes at the end."""
    if quiet:
        yield lambda step: None
        return
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with _bar(columns) as bar:
        task = bar.add_task("starting", total=total)
        begun = 0

        def step(name: str) -> None:
            nonlocal begun
            bar.update(task, description=name, completed=begun)
            begun += 1

        yield step


@contextmanager
def counting(what: str, *, quiet: bool) -> Iterator[Callable[[int, int], None]]:
    """Give a function that takes (done, total); the bar is on stderr and vanishes at the end."""
    if quiet:
        yield lambda done, total: None
        return
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with _bar(columns) as bar:
        task = bar.add_task("preparing", total=None)

        def count(done: int, total: int) -> None:
            bar.update(task, description=what if done else None, completed=done, total=total)

        yield count


def _bar(columns: Sequence[ProgressColumn]) -> Progress:
    """Return a bar on stderr; in a file, where it would leave an empty line, there is none."""
    from rich.progress import Progress

    err = console(stderr=True)
    return Progress(*columns, console=err, transient=True, disable=not err.is_terminal)


@contextmanager
def counting_meshes() -> Iterator[None]:
    """Show a bar for each grid of a mesh that is made meanwhile."""
    from ebac.worlds.grid import watching

    with ExitStack() as bars:
        count: Callable[[int, int], None] | None = None

        def counted(done: int, total: int) -> None:
            nonlocal count
            if count is None:  # most commands make none
                count = bars.enter_context(counting("measuring the mesh", quiet=False))
            count(done, total)

        with watching(counted):
            yield
