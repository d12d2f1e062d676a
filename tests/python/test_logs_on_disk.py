"""Files of logs while they are written: begun before power, deleted, cut, on a full disk; headings of CSV."""

import errno
import json
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.hardware import Configuration, OpenDevice, drive_setup
from ebac.logs import Event, Recorder, files, read

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"
runner = CliRunner()


@pytest.fixture(scope="module")
def device() -> Iterator[OpenDevice]:
    with ebac.Device.open(Configuration.load(EXAMPLE), simulate=True) as opened:
        yield opened


# --- begun before there is power ---


def test_a_folder_that_takes_no_file_is_found_before_the_drives_are_asked(
    device: OpenDevice, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[object] = []
    monkeypatch.setattr(drive_setup, "start", lambda *given: asked.append(given))
    with pytest.raises(FileNotFoundError, match=r"run\.mcap"):
        device.run(seconds=1, log=tmp_path / "no folder" / "run.mcap")
    assert asked == []
    assert device.report is None


@pytest.mark.parametrize("where", ["start", "started"])
def test_a_run_that_does_not_begin_leaves_no_log(
    device: OpenDevice, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str
) -> None:
    path = tmp_path / "run.mcap"
    there: list[bool] = []

    def refuses(*given: object) -> None:
        there.append(path.exists())
        raise RuntimeError("no")

    module = drive_setup if where == "start" else "ebac.hardware.power_up"
    if isinstance(module, str):
        monkeypatch.setattr(f"{module}.started", refuses)
    else:
        monkeypatch.setattr(module, "start", refuses)
    with pytest.raises(RuntimeError, match="no"):
        device.run(seconds=1, log=path)
    assert there == [True]
    assert not path.exists()


def test_power_goes_off_whatever_the_log_does(
    device: OpenDevice, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    off: list[object] = []

    def refuses(*_: object) -> None:
        raise RuntimeError("no")

    def full(file: Any, _: object) -> None:
        file.close()
        raise OSError(errno.ENOSPC, "disk full")

    power_off = drive_setup.power_off
    monkeypatch.setattr("ebac.hardware.power_up.started", refuses)
    monkeypatch.setattr("ebac.hardware.power_up.discard_log", full)
    monkeypatch.setattr(
        drive_setup, "power_off", lambda *given: (off.append(given), power_off(*given))[1]
    )
    with pytest.raises(OSError, match="disk full"):
        device.run(seconds=1, log=tmp_path / "run.mcap")
    assert len(off) == 1


# --- what other programs do to it ---


def recording(path: Path) -> tuple[Recorder, Callable[[], None]]:
    """A recorder with a few rows in its file, and what gives it more."""
    source = ebac.EBAC()._simulate(ebac.Scenario(seconds=1).setup())
    rows = source.empty_like(1000)
    raw = source.copy(0, 1000)[1].reshape(-1, source.row_bytes)
    given = iter(raw)

    def more() -> None:
        for _ in range(50):
            rows.append(next(given))

    recorder = Recorder(rows, path, interval=0.001)
    more()
    end = time.monotonic() + 20
    while recorder.written < 50 and time.monotonic() < end:
        time.sleep(0.001)
    return recorder, more


@pytest.mark.parametrize(
    ("harm", "told"),
    [
        (os.unlink, "it was deleted while it was written"),
        (lambda path: os.truncate(path, 100), "it was cut to 100 bytes while it was written"),
    ],
    ids=["deleted", "cut"],
)
def test_a_log_that_is_deleted_or_cut_ends_the_recording(
    tmp_path: Path, harm: Callable[[Path], None], told: str
) -> None:
    path = tmp_path / "run.mcap"
    recorder, more = recording(path)
    harm(path)
    more()
    with pytest.raises(OSError, match=f"recording stopped after 50 rows: {told}") as stopped:
        recorder.close()
    assert stopped.value.filename == str(path)
    assert recorder.written == 50


def test_a_file_that_is_cut_while_it_is_read_ends_as_if_it_ended_there(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    ebac.simulate(ebac.Scenario(seconds=10), "ebac").save(path)
    size = path.stat().st_size

    def cut(done: int, total: int) -> None:
        assert total == size
        if done > size / 2:
            os.truncate(path, size // 2)

    log = read(path, progress=cut)
    assert 0 < len(log.trace) < 10_001
    assert not log.condition.complete


def test_a_full_disk_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    ebac.simulate(ebac.Scenario(seconds=0.1), "ebac").save("run.mcap")

    def full(*given: object, **more: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def without_a_number(*given: object, **more: object) -> None:
        raise OSError("the library found no room")

    for fails, told in ((full, "No space left"), (without_a_number, "the library found no room")):
        monkeypatch.setattr(files, "write_mcap", fails)
        done = runner.invoke(app, ["log", "export", "run.mcap", "new.mcap"])
        assert done.exit_code == 2
        assert f"new.mcap: cannot be written ({told}" in done.output.replace("\n", " ")
        assert not Path("new.mcap").exists()


def test_a_recording_on_a_full_disk_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recorder, more = recording(tmp_path / "run.mcap")

    def full(*given: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(recorder._writer, "_write", full)
    more()
    with pytest.raises(OSError, match="after 50 rows: No space left on device") as stopped:
        recorder.close()
    assert stopped.value.errno == errno.ENOSPC


# --- headings and numbers ---


def test_a_heading_of_any_letters_comes_back_from_csv(tmp_path: Path) -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.01), "ebac")
    data: dict[str, Any] = {"t": trace["t"], 'a, "b"': trace["x"], "c;d": trace["v"]}
    columns = {n: ebac.ColumnInfo(name=n, unit="s" if n == "t" else "1", meaning="") for n in data}
    ebac.Trace(data=data, columns=columns, axes=1).save(tmp_path / "run.csv")
    back = ebac.load(tmp_path / "run.csv")
    assert list(back) == list(data)
    for name in data:
        assert (back[name] == data[name].ravel()).all()


@pytest.mark.parametrize("key", ["tick", "t"])
def test_true_is_no_number_of_an_event(key: str) -> None:
    event = Event(kind="note", message="", tick=1, t=1.0)
    document = json.loads(event.to_json(0))
    assert Event.from_json(json.dumps(document).encode()) == event
    with pytest.raises(ValueError, match="true is no number"):
        Event.from_json(json.dumps({**document, key: True}).encode())
