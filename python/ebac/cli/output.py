"""What every command shares: tables and JSON on stdout, progress and errors on stderr."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn, TypeAlias

import typer

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

#: Exit codes: the input was bad; the work itself failed.
BAD_INPUT = 2
FAILED = 1
#: A keyboard interrupt, as shells have it.
INTERRUPTED = 130

AsJson: TypeAlias = Annotated[
    bool, typer.Option("--json", help="Print one JSON document in SI units, and nothing else.")
]


def console(*, stderr: bool = False) -> Console:
    """Return where people read."""
    from rich.console import Console

    return Console(stderr=stderr, highlight=False)


def say(text: str = "", *, style: str = "") -> None:
    """Print a line for people, wrapped between words."""
    console().print(text, style=style, markup=False)


def fail(message: str, *, code: int = BAD_INPUT) -> NoReturn:
    """End the command with one sentence on stderr and nothing else."""
    console(stderr=True).print(f"[bold red]Error:[/] {_plain(message)}", soft_wrap=True)
    raise typer.Exit(code)


def _plain(text: str) -> str:
    from rich.markup import escape

    return escape(" ".join(text.split()))


@contextmanager
def refusing() -> Iterator[None]:
    """Turn what the library says about bad input into the end of the command."""
    try:
        yield
    except FileNotFoundError as error:
        fail(f"{error.filename}: there is no such file")
    except OSError as error:
        fail(f"{error.filename}: cannot be read ({error.strerror})")
    except (KeyError, TypeError, ValueError) as error:
        from ebac.cli.setting import in_options

        fail(in_options(str(error.args[0]) if error.args else str(error)))


@contextmanager
def results(out: Path | None) -> Iterator[Path | None]:
    """Give a draft of the folder `out`, None for none; one that cannot be written ends all."""
    from ebac.folder import filled

    if out is None:
        yield None
        return
    try:
        with filled(out) as draft:
            yield draft
    except (FileExistsError, NotADirectoryError):
        fail(f"--out {out}: is a file or lies inside one; give the name of a folder")
    except OSError as error:
        fail(f"--out {out}: cannot be written ({error.strerror}); give another folder")


def table(headings: Sequence[str], *, numbers: Sequence[int] = ()) -> Table:
    """Return an empty table; the columns `numbers` stand flush right."""
    from rich import box
    from rich.table import Table

    grid = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    for i, heading in enumerate(headings):
        grid.add_column(heading, justify="right" if i in numbers else "left")
    return grid


def document(command: str, rows: Sequence[Mapping[str, Any]], **more: Any) -> str:
    """Return the JSON of a command: its name, the version, `more` and the list `rows`.

    A number that is not finite becomes null.
    """
    from ebac import __version__

    values = {"command": command, "version": __version__, **more, "rows": rows}
    return json.dumps(_finite(values), indent=2, allow_nan=False)


def _finite(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(name): _finite(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not isfinite(value) else value


def csv_table(path: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    """Write rows of the same names as CSV."""
    import csv

    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def list_files(out: Path, names: Sequence[str]) -> None:
    """Tell which files were written."""
    say(f"\nWritten to {out}/:", style="bold")
    indented(", ".join(names))


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
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console(stderr=True), transient=True) as bar:
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
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    columns = (TextColumn(what), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console(stderr=True), transient=True) as bar:
        task = bar.add_task(what, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)
