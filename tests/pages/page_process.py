"""Runs the steps of pages, each page in a process of its own: a fork of this one, which has made the usual imports.

It reads a request a line, a JSON object: the file of the steps, a folder, an environment, and a file for what is
printed; it answers with the exit code. Commands of ebac run inside the fork; whatever else in bash. The blocks of
Python share one namespace, as a reader who types them would have it.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import IO, Any

from busy_machine import patient_file

#: Longest time that what runs until Ctrl-C gets to say so, and how long it then runs before the next step [s].
START, SETTLE = 3.0, 0.5
#: Commands that write the configuration of a run.
WRITES = re.compile(r"^ebac demo .*(joystick|handle|gastroscope)")
#: What only a shell can do.
SHELL = re.compile(r"[|&;<>$*`]")

#: What runs until Ctrl-C: the command, its process and what it prints.
Beside = tuple[str, "subprocess.Popen[bytes]", IO[bytes]]


def main(steps: list[dict[str, Any]]) -> None:
    beside: list[Beside] = []
    base = Path.cwd()
    names: dict[str, Any] = sys.modules["__main__"].__dict__
    try:
        for step in steps:
            text, room = step["text"], base / step["room"]
            room.mkdir(exist_ok=True)
            os.chdir(room)
            print(f"\n>>> {text}", flush=True)
            if step["kind"] == "python":
                exec(compile("\n" * (step["line"] - 1) + text, step["page"], "exec"), names)
            elif step["action"] == "beside":
                if " simulate" in text:  # in place of the one before, whose port it needs
                    end(beside)
                beside.append(started(text))
            else:
                code = shell(text)
                expected = step["action"] == "fails"
                if bool(code) != expected:
                    sys.exit(f"line {step['line']}: {text}\nended with exit code {code}")
                if WRITES.search(text):
                    for file in Path().glob("*.toml"):
                        known = file.read_text()
                        if "[limits]" in known:
                            file.write_text(patient_file(known))
        # A side of a link ends well when the other one tells it so.
        ended = [text for text, process, _ in beside if process.poll() not in (None, 0)]
        if ended:
            sys.exit(f"did not run until Ctrl-C, or until its other side ended: {ended}")
    finally:
        end(beside)


def started(text: str) -> Beside:
    """Start what runs until Ctrl-C; most of it says so as soon as it is ready."""
    said = tempfile.TemporaryFile()  # noqa: SIM115 - `end` reads it and closes it
    process = subprocess.Popen(["bash", "-c", f"exec {text}"], stdout=said, stderr=said)
    latest = time.monotonic() + START
    while process.poll() is None and time.monotonic() < latest:
        if b"Ctrl-C" in os.pread(said.fileno(), 65536, 0):
            time.sleep(SETTLE)
            break
        time.sleep(0.02)
    return text, process, said


def end(beside: list[Beside]) -> None:
    """End what runs until Ctrl-C, and print what it said."""
    for _, process, _ in beside:
        process.send_signal(signal.SIGINT)
    for text, process, said in beside:
        process.wait(20)
        with said:
            told = os.pread(said.fileno(), 65536, 0).decode(errors="replace")
        print(f"\n>>> {text}\n{told}", flush=True)
    beside.clear()


def shell(text: str) -> int:
    """Run one command and return its exit code."""
    export = re.fullmatch(r"export ((?:\w+=\S+ ?)+)", text)
    if export:
        os.environ.update(pair.split("=", 1) for pair in export[1].split())
        return 0
    if not text.startswith("ebac ") or SHELL.search(text):
        return subprocess.run(["bash", "-c", text], check=False).returncode
    from ebac.cli import app

    try:
        app(shlex.split(text)[1:], prog_name="ebac")
    except SystemExit as end:
        return int(end.code or 0)
    finally:
        if "matplotlib.pyplot" in sys.modules:
            sys.modules["matplotlib.pyplot"].close("all")
    return 0


def serve() -> None:
    """Follow one page after the other, until there is no further request."""
    import plain_pictures

    import ebac.cli  # noqa: F401

    plain_pictures.SAVE.write_png = plain_pictures.draw_plain
    with tempfile.TemporaryFile("w+", encoding="utf-8") as told:
        for line in sys.stdin:
            child = os.fork()
            if child == 0:
                request = json.loads(line)
                begin(request)
                main(json.loads(Path(request["steps"]).read_text(encoding="utf-8")))
                # Not where it failed: if its picture is why, the next try meets the same.
                print(*plain_pictures.drawn, sep="\n", file=told)
                return
            _, status = os.waitpid(child, 0)
            told.seek(0)
            plain_pictures.drawn.update(told.read().splitlines())
            print(os.waitstatus_to_exitcode(status), flush=True)


def begin(request: dict[str, Any]) -> None:
    """Turn to the folder, the environment and the files of a request."""
    os.chdir(request["room"])
    os.environ.clear()
    os.environ.update(request["environment"])
    for stream, name, flags in (
        (sys.stdin, request["input"], os.O_RDONLY),
        (sys.stdout, request["output"], os.O_WRONLY | os.O_CREAT | os.O_APPEND),
        (sys.stderr, request["output"], os.O_WRONLY | os.O_APPEND),
    ):
        file = os.open(name, flags, 0o644)
        os.dup2(file, stream.fileno())
        os.close(file)
    sys.stdin = open(0, closefd=False)  # noqa: SIM115 - the one before is amid its lines


if __name__ == "__main__":
    serve()
