"""Draws a picture of the gallery: commands of ebac in an empty folder, in a process that nothing else has used.

That process is a fork of one that has imported ebac, NumPy and matplotlib, which takes longer than most pictures do.
"""

import multiprocessing
import os
import shlex
import sys
from pathlib import Path

FORKS = multiprocessing.get_context("forkserver")
#: What the first process imports. `__main__` is Sphinx: every fork would import it again.
IMPORTED = ["__main__", "ebac.cli", "ebac.plot", "matplotlib.backends.backend_agg"]


def draw(script: str, room: Path) -> str:
    """Run the commands in a folder; return what they said where one failed, else nothing."""
    told = room.with_suffix(".txt")
    FORKS.set_forkserver_preload(IMPORTED)
    child = FORKS.Process(target=_run, args=(script, room, told))
    child.start()
    child.join()
    said = told.read_text(encoding="utf-8", errors="replace") if told.exists() else ""
    told.unlink(missing_ok=True)
    return f"{said}\nexit code {child.exitcode}" if child.exitcode else ""


def _run(script: str, room: Path, told: Path) -> None:
    """Run the commands, what they print in a file, until one fails."""
    os.chdir(room)
    os.environ["MPLBACKEND"] = "Agg"
    file = os.open(told, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(file, 1)
    os.dup2(file, 2)
    for line in script.splitlines():
        _command(line)


def _command(line: str) -> None:
    """Run one line as its reader would: the program ends by an exit code."""
    from ebac.cli import app

    words = shlex.split(line)
    if words[0] != "ebac":
        sys.exit(f"no command of ebac: {line}")
    try:
        app(words[1:], prog_name="ebac")
    except SystemExit as end:
        if end.code:
            raise
