"""Where a command writes its files, and in which formats it draws."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from ebac._util.arguments import unknown
from ebac._util.figure_formats import FORMATS
from ebac.cli import completion, output

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PANEL = "Results"

Force: TypeAlias = Annotated[
    bool,
    typer.Option(
        "--force", help="Write to a folder that already contains files.", rich_help_panel=PANEL
    ),
]


@dataclass(frozen=True, kw_only=True)
class FigureOptions:
    """Formats and width of figures, and whether they have titles."""

    figure_format: Annotated[
        list[str] | None,
        typer.Option(
            "--format",
            help="Format of figures: png, pdf or svg; several separated by commas.",
            show_default="png",
            autocompletion=completion.several(completion.one_of(*FORMATS)),
            rich_help_panel=PANEL,
        ),
    ] = None
    width: Annotated[
        str | None,
        typer.Option(
            "--width",
            help="Width of figures: single (89 mm), double (183 mm), or a number of millimetres.",
            show_default="as drawn",
            rich_help_panel=PANEL,
        ),
    ] = None
    no_title: Annotated[
        bool,
        typer.Option(
            "--no-title",
            help="Leave the titles out of figures, for a paper whose captions say what was simulated.",
            rich_help_panel=PANEL,
        ),
    ] = False

    def check(self) -> None:
        """End the command on a wrong format or width, before any work."""
        self.formats()
        if self.width is not None:
            from ebac.plot.save import millimetres

            with output.refusing():
                millimetres(self.width)

    def formats(self) -> list[str]:
        """Return the extensions of the figures."""
        given = ["png"] if self.figure_format is None else self.figure_format
        names = output.words(given)
        if not names:
            output.fail(f"--format: is empty; must be {', '.join(FORMATS[:-1])} or {FORMATS[-1]}")
        for name in names:
            if name not in FORMATS:
                output.fail(unknown(f"--format {name}", name, FORMATS))
        return names

    def save(self, figure: Figure, folder: Path, name: str) -> list[str]:
        """Write a figure in every format; return the names of the files."""
        files = [f"{name}.{extension}" for extension in self.formats()]
        for file in files:
            self.write(figure, folder / file)
        return files

    def write(self, figure: Figure, file: Path) -> None:
        """Write a figure to one file, in the format of its extension."""
        from ebac.plot import save

        save(figure, file, width=self.width, title=not self.no_title)


@dataclass(frozen=True, kw_only=True)
class ResultOptions(FigureOptions):
    """The folder of the results, and the figures in it."""

    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="Folder for the results, new or empty; with --json, written only if given.",
            show_default="ebac-COMMAND, then ebac-COMMAND-2, ...",
            rich_help_panel=PANEL,
        ),
    ] = None
    force: Force = False
    no_files: Annotated[
        bool, typer.Option("--no-files", help="Write no files.", rich_help_panel=PANEL)
    ] = False

    def folder(self, command: str, *, as_json: bool, resume: str = "") -> Path | None:
        """Return the folder to write to, None for none; one that has files ends the command.

        Parameters
        ----------
        command : str
            Name of the command, for the folder's own name.
        as_json : bool
            Whether to write only where --out is given.
        resume : str
            The folder of runs to continue from, in that of --out or in the last of this command, where there is one; ""
            starts anew.
        """
        self.check()
        if self.no_files:
            for option, given in (("--out", self.out is not None), ("--resume", resume)):
                if given:
                    output.fail(
                        f"--no-files and {option} exclude each other: leave one of them out"
                    )
            return None
        if self.out is None:
            if resume and as_json:
                output.fail("--resume continues in a folder: give it with --out")
            if as_json:
                return None
            own = own_folder(f"ebac-{command}", last=bool(resume))
            return _resumed(own, command, resume) if resume else own
        if resume and not self.force:
            return _resumed(self.out, command, resume)
        return free_folder(self.out, force=self.force)

    def report(
        self,
        folder: Path | None,
        command: str,
        document: str,
        *,
        fill: Callable[[Path], object],
        show: Callable[[], object],
        as_json: bool,
    ) -> None:
        """Write the results of a command, then print them.

        Parameters
        ----------
        folder : Path or None
            As `folder` returned it.
        command : str
            Name of the command, and of the file with its document.
        document : str
            What --json prints.
        fill : callable
            Writes all other files to a draft of the folder.
        show : callable
            Prints tables, without --json.
        as_json : bool
            Whether the document is printed.
        """
        files: list[str] = []
        with output.results(folder) as draft:
            if draft is not None:
                (draft / f"{command}.json").write_text(document + "\n", encoding="utf-8")
                fill(draft)
                files = sorted(file.name for file in draft.iterdir())
        if as_json:
            typer.echo(document)
            return
        show()
        if folder is not None:
            output.list_files(folder, files)


#: Folders that no other command may take until this one has ended, and what lets go of them.
_mine: set[Path] = set()
_claims = ExitStack()


@contextmanager
def claims() -> Iterator[None]:
    """Let go of the folders of a command at its end."""
    with _claims:
        _claims.callback(_mine.clear)
        yield


def _claim(folder: Path, where: str) -> bool:
    """Return whether a folder had no files, and is this command's now."""
    from ebac._util.atomic_folder import claimed

    if folder.absolute() in _mine:
        return True
    with output.writing(where, "folder"):
        free = _claims.enter_context(claimed(folder))
    if free:
        _mine.add(folder.absolute())
    return free


def free_folder(out: Path, *, force: bool) -> Path:
    """Return the folder of --out; one that has files ends the command, unless forced."""
    if not force and not _claim(out, f"--out {out}"):
        output.fail(f"--out {out}: has files; give a new folder, or --force to write into this one")
    return out


def _resumed(out: Path, command: str, runs: str) -> Path:
    """Return a folder that holds such runs, or one to begin in; one that has other files ends the command."""
    from ebac._util.atomic_folder import has_files

    if not (out / runs / "sweep.json").is_file():
        if has_files(out):
            output.fail(
                f"--resume: {out} has files but no runs of `ebac {command}` ({runs}/sweep.json) to continue; give the "
                f"folder of the stopped {command} with --out, or leave --resume out to start in a new folder"
            )
        output.note(f"--resume: {out} has no runs yet, begins with the first")
    return out


def own_folder(name: str, *, last: bool = False) -> Path:
    """Return `name`, or `name-2` and so on, the first that has no files, or the last that has."""
    if last:
        there = [path for path in Path().glob(f"{name}*") if _number(path, name) and path.is_dir()]
        return max(there, key=lambda path: _number(path, name), default=Path(name))
    for number in count(1):
        path = Path(name if number == 1 else f"{name}-{number}")
        if (path.is_dir() or not path.exists()) and _claim(path, f"{path}"):
            break
    return path


def free_file(file: Path) -> Path:
    """Return a name like this one that no file has: run.png, run-2.png and so on."""
    number, free = 1, file
    while free.exists():
        number += 1
        free = file.with_stem(f"{file.stem}-{number}")
    return free


def _number(path: Path, name: str) -> int:
    found = re.fullmatch(rf"{re.escape(name)}(?:-(\d+))?", path.name)
    return int(found[1] or 1) if found else 0


def new_file(option: str, file: Path, *, force: bool) -> Path:
    """Return a file to write; one that exists ends the command, unless forced."""
    if file.is_dir():
        output.fail(f"{option} {file}: is a folder; give the name of a file")
    if file.exists() and not force:
        output.fail(f"{option} {file}: exists; give another name, or --force to replace it")
    if not file.parent.is_dir():
        output.fail(f"{option} {file}: there is no folder {file.parent}; make it first")
    return file
