"""python-can's own logger, as a program beside this one."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path


def logged(channel: str, log: Path, *, seconds: float) -> str:
    """Log a channel of this library's interface until Ctrl-C, and return the text of the log."""
    program = [sys.executable, "-u", "-m", "can.logger", "-i", "ebac", "-c", channel]
    pipe, merged = subprocess.PIPE, subprocess.STDOUT
    with subprocess.Popen([*program, "-f", str(log)], stdout=pipe, stderr=merged, text=True) as run:
        try:
            assert run.stdout
            connected = run.stdout.readline()
            assert connected.startswith(f"Connected to EbacBus: ebac channel '{channel}'")
            run.stdout.readline()
            time.sleep(seconds)
            run.send_signal(signal.SIGINT)
            run.communicate(timeout=20)
        finally:
            run.kill()
    return log.read_text(encoding="utf-8")
