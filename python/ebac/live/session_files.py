"""Files that a session writes: logs of its rows, its scenario."""

from __future__ import annotations

import threading
from datetime import UTC, datetime
from pathlib import Path

from ebac._util.atomic_file import write_text
from ebac.live.session_parts import SessionParts


class SessionFiles(SessionParts):
    """Logs and scenarios of a session, named by the time."""

    folder: Path
    kept: list[Path]
    _lock: threading.RLock

    def record(self) -> Path:
        """Write the rows to a log from here on, named by the time; return its path."""
        with self._lock:
            run = self.run
            if run is None or run.done:
                raise RuntimeError("nothing runs: start first, then record")
            if run.recorder is not None:
                return run.recorder.path
            path = self._new(".mcap")
            files = {"choices.txt": repr(self.choices)}
            run.record(path, files=files, first=run.ticks)
            self.kept.append(path)
            return path

    def stop_recording(self) -> int:
        """Close the log; return its rows."""
        with self._lock:
            if self.run is None or self.run.recorder is None:
                return 0
            recorder, self.run.recorder = self.run.recorder, None
            recorder.close()
            return recorder.written

    def save(self) -> Path:
        """Write the scenario to a TOML file, named by the time; return its path."""
        with self._lock:
            path = self._new(".toml")
            text = self.scenario.to_toml(folder=path.parent)
            path.touch(
                exist_ok=False
            )  # the name of this session, should another one write in the same second
            try:
                write_text(path, f"# law: {self.choices.law}\n{text}")
            except OSError:
                path.unlink()
                raise
            self.kept.append(path)
            return path

    def _new(self, suffix: str) -> Path:
        self.folder.mkdir(parents=True, exist_ok=True)
        stem = f"live-{datetime.now(UTC):%Y%m%d-%H%M%S}"
        names = (f"{stem}{n}{suffix}" for n in ("", *(f"-{k}" for k in range(1, 1000))))
        return next(self.folder / name for name in names if not (self.folder / name).exists())
