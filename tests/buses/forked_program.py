"""`ebac` as a fork of this process: to start an interpreter and import takes 15 s of a core where QEMU emulates it."""

import os
import signal
import subprocess
import sys
import time
from typing import Never


class ForkedProgram:
    """Runs `ebac WORDS`; what of a `subprocess.Popen` the tests of SocketCAN use."""

    def __init__(self, *words: str) -> None:
        its_input, write = os.pipe()
        read, its_output = os.pipe()
        self.pid = os.fork()
        if self.pid == 0:
            os.close(write)
            os.close(read)
            _run(words, its_input, its_output)
        os.close(its_input)
        os.close(its_output)
        self.stdin = os.fdopen(write, "w")
        self.stdout = os.fdopen(read)
        self.returncode: int | None = None

    def __enter__(self) -> "ForkedProgram":
        return self

    def __exit__(self, *_: object) -> None:
        self.stdin.close()
        self.wait(180)
        self.stdout.close()

    def poll(self) -> int | None:
        if self.returncode is None:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.returncode = os.waitstatus_to_exitcode(status)
        return self.returncode

    def wait(self, timeout: float) -> int:
        end = time.monotonic() + timeout
        while self.poll() is None:
            if time.monotonic() > end:
                raise subprocess.TimeoutExpired("ebac", timeout)
            time.sleep(0.05)
        assert self.returncode is not None
        return self.returncode

    def send_signal(self, number: int) -> None:
        if self.poll() is None:
            os.kill(self.pid, number)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)


def _run(words: tuple[str, ...], given: int, told: int) -> Never:
    """Be the program; nothing of pytest may run behind it."""
    code = 1
    try:
        os.dup2(given, 0)
        os.dup2(told, 1)
        sys.stdin, sys.stdout = open(0, closefd=False), open(1, "w", closefd=False)  # noqa: SIM115
        sys.stderr = open(2, "w", closefd=False)  # noqa: SIM115
        from ebac.cli import app

        app(list(words), prog_name="ebac")
        code = 0
    except SystemExit as end:
        code = int(end.code or 0)
    finally:
        sys.stdout.flush()
        os._exit(code)
