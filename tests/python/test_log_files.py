"""Traces in files of every format, and `ebac log`."""

import gc
import json
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.identify import load
from ebac.logs import FORMATS, Event, Recorder, read
from ebac.operators import Operators
from ebac.tracking import read_path

runner = CliRunner()
OF_AN_EXTRA = {".parquet": "pyarrow", ".mat": "scipy", ".h5": "h5py"}


@pytest.fixture(params=FORMATS)
def kind(request: pytest.FixtureRequest) -> str:
    """Each format's extension, where the library that writes it is installed."""
    if library := OF_AN_EXTRA.get(request.param):
        pytest.importorskip(library)
    return str(request.param)


@pytest.fixture(params=[1, 2], ids=["one axis", "two axes"])
def trace(request: pytest.FixtureRequest, run: Any) -> ebac.Trace:
    device = ebac.Device(kinematics=ebac.Linear(axes=request.param))
    world = ebac.Corner() if request.param > 1 else ebac.Wall()
    traced = run("ebac", device=device, environment=world, seconds=0.2, jitter=0.2)
    assert isinstance(traced, ebac.Trace)
    return traced


# --- formats ---


def test_threads_that_save_one_file_leave_it_whole(kind: str, run: Any, tmp_path: Path) -> None:
    traced = run("ebac", seconds=0.05)
    with ThreadPoolExecutor(4) as threads:
        list(threads.map(traced.save, [tmp_path / f"run{kind}"] * 12))
    assert len(ebac.load(tmp_path / f"run{kind}")) == len(traced)
    assert [one.name for one in tmp_path.iterdir()] == [f"run{kind}"]


def test_csv_comes_back(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.save(tmp_path / "run.csv")
    back = ebac.load(tmp_path / "run.csv")
    assert list(back) == list(trace)
    assert back.axes == trace.axes
    for name in trace:
        assert back[name].shape == trace[name].shape, name
        assert (back[name] == trace[name]).all() or np.array_equal(
            back[name], trace[name], equal_nan=True
        ), name
        assert back.columns[name].unit == trace.columns[name].unit
    assert back["counts"].dtype == np.int64
    assert back["x"].dtype == np.float64


def test_npz_and_mcap_come_back_whole(trace: ebac.Trace, tmp_path: Path) -> None:
    for name in ("run.npz", "run.mcap", "RUN.MCAP"):
        trace.save(tmp_path / name)
        back = ebac.load(tmp_path / name)
        assert back.scenario == trace.scenario
        assert (back.law, back.law_repr, back.columns) == (trace.law, trace.law_repr, trace.columns)
        for column in trace:
            assert back[column].tobytes() == trace[column].tobytes()


@pytest.mark.slow
def test_parquet_holds_numbers_and_units(trace: ebac.Trace, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    trace.save(tmp_path / "run.parquet")
    table = parquet.read_table(tmp_path / "run.parquet")
    for name, info, values in trace.flat():
        assert table[name].to_numpy().tobytes() == values.tobytes(), name
        told = table.schema.field(name).metadata
        assert (told[b"unit"].decode(), told[b"meaning"].decode()) == (info.unit, info.meaning)
    assert ebac.Scenario.from_toml(table.schema.metadata[b"scenario"].decode()) == trace.scenario
    frame = pytest.importorskip("pandas").read_parquet(tmp_path / "run.parquet")
    assert len(frame) == len(trace)


def test_mat_holds_numbers_and_units(trace: ebac.Trace, tmp_path: Path) -> None:
    io = pytest.importorskip("scipy.io")
    trace.save(tmp_path / "run.mat")
    read_back = io.loadmat(tmp_path / "run.mat")
    for name in trace:
        values = read_back[name.replace(".", "_")]
        assert values.shape == (len(trace), 1 if trace[name].ndim == 1 else trace.axes)
        expected = np.ascontiguousarray(trace[name]).reshape(values.shape)
        assert np.ascontiguousarray(values).astype(expected.dtype).tobytes() == expected.tobytes()
        unit = read_back["units"][0, 0][name.replace(".", "_")].item()
        assert unit == trace.columns[name].unit
    assert read_back["about"][0, 0]["law"].item() == "ebac"


def test_hdf5_holds_numbers_and_units(trace: ebac.Trace, tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    for part in (trace, trace[:0.0]):
        part.save(tmp_path / "run.h5")
        with h5py.File(tmp_path / "run.h5") as file:
            assert set(file) == set(trace)
            for name in part:
                assert file[name][()].tobytes() == part[name].tobytes(), name
                assert file[name].attrs["unit"] == trace.columns[name].unit
            assert file.attrs["law_repr"] == trace.law_repr


def test_a_file_appears_whole_or_not_at_all(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.1), "tca")
    path = tmp_path / f"run{kind}"
    trace.save(path)
    before = path.read_bytes()
    monkeypatch.setattr(Path, "replace", lambda *_: (_ for _ in ()).throw(OSError("no")))
    with pytest.raises(OSError, match="no"):
        trace.save(path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("kind", [".npz", ".parquet"])  # HDF5 leaves four of 6000 unnoticed
@given(place=st.floats(0, 1, exclude_max=True), bit=st.integers(0, 7))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_flipped_bit_is_found_or_changes_nothing(
    kind: str, place: float, bit: int, run: Any, tmp_path: Path
) -> None:
    if library := OF_AN_EXTRA.get(kind):
        pytest.importorskip(library)
    trace = run("ebac", seconds=0.02)
    path, saved = tmp_path / f"run{kind}", tmp_path / f"saved{kind}"
    if not saved.exists():
        trace.save(saved)
    flipped = bytearray(saved.read_bytes())
    flipped[int(place * len(flipped))] ^= 1 << bit
    path.write_bytes(flipped)
    try:
        back = ebac.load(path)
    except ValueError as error:
        assert str(path) in str(error)  # noqa: PT017
        return
    assert (set(back), back.law, back.scenario) == (set(trace), trace.law, trace.scenario)
    for name in trace:
        assert back[name].tobytes() == trace[name].tobytes(), name
        unit, meaning = trace.columns[name].unit, trace.columns[name].meaning
        assert back.columns[name].unit in (unit, "1")  # Parquet may lose the texts of a column
        assert back.columns[name].meaning in (meaning, "")


DAMAGED = r"run\.\w+: column x is damaged \(.+\); use a copy of it, or write it again"
CHANGED = "damaged, or changed; use a copy .* If it is changed on purpose, delete its crc32"


def flip(path: Path, place: int) -> None:
    damaged = bytearray(path.read_bytes())
    damaged[place] ^= 4
    path.write_bytes(damaged)


def test_a_damaged_column_of_parquet_is_named_and_what_was_changed_is_read_without_checksum(
    run: Any, tmp_path: Path
) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    path, trace = tmp_path / "run.parquet", run("ebac", seconds=0.02)
    trace.save(path)
    table = parquet.read_table(path)
    chunk = parquet.read_metadata(path).row_group(0).column(table.column_names.index("x"))
    first = chunk.dictionary_page_offset or chunk.data_page_offset
    flip(path, first + chunk.total_compressed_size // 2)
    with pytest.raises(ValueError, match=DAMAGED):
        ebac.load(path)
    texts = {**table.schema.metadata, b"law": b"mine"}
    parquet.write_table(table.replace_schema_metadata(texts), path)
    with pytest.raises(ValueError, match=f"law or scenario is {CHANGED}"):
        ebac.load(path)
    del texts[b"crc32"]
    parquet.write_table(
        table.replace_schema_metadata(texts), path
    )  # as older ones, no page has one
    assert ebac.load(path).law == "mine"
    parquet.write_table(table.slice(5, 10).select(["t", "x"]), path)
    assert (ebac.load(path)["x"] == trace["x"][5:15]).all()


def test_a_damaged_column_of_hdf5_is_named_and_what_was_changed_is_read_without_checksum(
    run: Any, tmp_path: Path
) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "run.h5"
    run("ebac", seconds=0.02).save(path)
    with h5py.File(path) as file:
        assert all(file[name].fletcher32 for name in file)
        chunk = file["x"].id.get_chunk_info(0)
    flip(path, chunk.byte_offset + chunk.size // 2)
    with pytest.raises(ValueError, match=DAMAGED):
        ebac.load(path)
    flip(path, chunk.byte_offset + chunk.size // 2)
    with h5py.File(path, "a") as file:
        file["x"].attrs["unit"] = "mm"
    with pytest.raises(ValueError, match=f"the name, unit or meaning of column x is {CHANGED}"):
        ebac.load(path)
    with h5py.File(path, "a") as file:
        del file["x"].attrs["crc32"]
    assert ebac.load(path).columns["x"].unit == "mm"


def test_an_unknown_extension_is_refused(tmp_path: Path) -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.1), "tca")
    with pytest.raises(ValueError, match=r"run\.xlsx: must end in \.mcap, \.npz, \.csv, \.parquet"):
        trace.save(tmp_path / "run.xlsx")
    with pytest.raises(ValueError, match=r"run\.xlsx: must end in \.mcap, \.npz, \.csv"):
        ebac.load(tmp_path / "run.xlsx")
    for name in ("run.mcap", "run.npz", "run.csv"):
        with pytest.raises(FileNotFoundError):
            ebac.load(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_missing_library_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.1), "tca")
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    for kind, extra in ((".mat", "log"), (".h5", "log"), (".parquet", "sweep")):
        with pytest.raises(ModuleNotFoundError, match=rf"pip install 'ebac\[{extra}\]'"):
            trace.save(tmp_path / f"run{kind}")
    assert list(tmp_path.iterdir()) == []


@given(text=st.text(alphabet="tx[m], _01.e-\n", max_size=60))
@settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_any_text_as_csv_is_read_or_refused_by_its_name(tmp_path: Path, text: str) -> None:
    path = tmp_path / "any.csv"
    for start in ("", "tick,t [s],x [m]\n0,0.0,1.0\n"):
        path.write_text(start + text)
        with warnings.catch_warnings(action="ignore"):  # of a last line without an end
            try:
                assert "t" in ebac.load(path)
            except ValueError as error:
                if "any.csv" not in str(error):
                    raise


@pytest.mark.parametrize("ours", [True, False])
@given(share=st.floats(0, 1))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_csv_that_was_cut_anywhere_has_whole_rows_or_is_refused_or_warned_of(
    ours: bool, share: float, tmp_path: Path, run: Any
) -> None:
    trace, path = run("ebac", seconds=0.05), tmp_path / "run.csv"
    trace.to_csv(path)
    text = path.read_text()
    if not ours:
        rows = [line.split(",") for line in text.splitlines(keepends=True)]
        text = "".join(f"{row[1]},{row[-1]}" for row in rows)
    path.write_text(text[: round(share * len(text))])
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        try:
            back = ebac.load(path)
        except ValueError as error:
            assert str(path) in str(error)  # noqa: PT017
            return
    if warned:
        assert not ours
        assert f"{path}: its last line has no end, so it may be cut" in str(warned[0].message)
        return
    for name in back:
        assert np.array_equal(1.0 * back[name], 1.0 * trace[name][: len(back)], equal_nan=True)


def test_every_reader_of_csv_warns_of_a_last_line_without_an_end(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    readers: dict[str, Callable[[Path], Any]] = {
        "t [s],x [m],force [N]\n" + "".join(f"{i}e-3,{i}e-3,{i % 3}\n" for i in range(400)): load,
        "x [mm],y [mm]\n1.5,2.5\n3.5,4.5\n": read_path,
        "mass_kg,damping_Ns_per_m,stiffness_N_per_m,target_m\n1,2,300,0.01\n": Operators.from_csv,
    }
    for text, reader in readers.items():
        path.write_text(text)
        reader(path)
        path.write_text(text[:-1])
        cut = r"log\.csv: its last line has no end, .* check its"
        with pytest.warns(UserWarning, match=cut) as warned:
            reader(path)
        assert warned[0].filename == __file__
        path.write_text(text + "# the end")
        reader(path)


def test_a_csv_of_ours_that_was_cut_is_refused_with_the_remedy(tmp_path: Path, run: Any) -> None:
    path = tmp_path / "run.csv"
    run("ebac", seconds=0.05).to_csv(path)
    whole = path.read_text()
    path.write_text(whole[:-3])
    with pytest.raises(
        ValueError,
        match=r"run\.csv: its last line has no end, .*; delete the last line, or end it if it is whole$",
    ):
        ebac.load(path)
    with pytest.raises(
        ValueError,
        match=r"run\.csv: its last line has no end, .*; delete the last line, or end it if it is whole$",
    ):
        load(path)


# --- the command line ---


def invoke(*words: object, code: int = 0) -> str:
    result = runner.invoke(app, ["log", *map(str, words)])
    assert result.exit_code == code, result.output
    return " ".join(result.output.split())


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    """A recorded log with a lost row, a parameter change and an attachment."""
    source = ebac.EBAC()._simulate(ebac.Scenario(seconds=0.2).setup())
    rows = source.empty_like(500)
    path = tmp_path / "run.mcap"
    with Recorder(
        rows, path, law="ebac", law_repr="EBAC()", start=1.6e9, files={"joystick.toml": "[drive]"},
        scenario=ebac.Scenario(seconds=0.2),
    ) as recorder:  # fmt: skip
        _, raw = source.copy(0, source.count)
        for i, row in enumerate(raw.reshape(-1, source.row_bytes)):
            if i != 100:
                rows.append(row)
        recorder.event("parameter", "damping raised", damping_Ns_per_m=40)
    return path


def test_info_says_what_is_in_a_log(recorded: Path) -> None:
    told = json.loads(invoke("info", recorded, "--json"))
    assert told["command"] == "log info"
    assert (told["complete"], told["log_rows"], told["lost_rows"]) == (True, 200, 1)
    assert told["gaps"] == [{"after_tick": 99, "t_s": pytest.approx(0.099), "rows": 1}]
    assert told["rate_Hz"] == pytest.approx(1000)
    assert told["start_s"] == 1.6e9
    assert told["events"][0]["values"] == {"damping_Ns_per_m": 40}
    assert set(told["attachments"]) == {"scenario.toml", "joystick.toml"}
    by_name = {row["column"]: row for row in told["rows"]}
    assert (by_name["x"]["unit"], by_name["x"]["type"]) == ("m", "float64")
    shown = invoke("info", recorded)
    for words in ("complete", "200", "1 missing", "2020-09-13 12:26:40 UTC", "1 row after tick 99",
                  "damping raised"):  # fmt: skip
        assert words in shown, words
    assert "fault 0 (none) 0 (none)" in shown
    assert "state 2 (run) 2 (run)" in shown
    assert "handle position" not in shown
    assert "handle position" in invoke("info", recorded, "--meanings")


def test_info_shows_law_and_parameters_for_people(tmp_path: Path) -> None:
    path = tmp_path / "run.npz"
    ebac.simulate(ebac.Scenario(seconds=0.2), "ebac").save(path)
    shown = " ".join(invoke("info", path).split())
    assert "law ebac parameters damping = 2, mass = 0.25," in shown
    assert "count = 3.068e-05, peak_force = 42.4," in shown
    assert "EBAC(" not in shown


def test_info_shows_words_of_a_drive_in_hexadecimal_and_by_name(tmp_path: Path) -> None:
    path = tmp_path / "run.npz"
    ebac.simulate(ebac.Scenario(seconds=0.1), "direct", through="can").save(path)
    shown = " ".join(invoke("info", path).split())
    assert shown.count("0x1237 (operation") == shown.count("enabled)") == 2
    assert "bus.controlword 0x000F 0x000F" in shown
    assert "bus.emergency 0 0" in shown


def test_info_of_a_log_that_was_cut(recorded: Path) -> None:
    whole = recorded.read_bytes()
    recorded.write_bytes(whole[:-30])
    assert json.loads(invoke("info", recorded, "--json"))["complete"] is False
    assert "its end is missing" in invoke("info", recorded)
    recorded.write_bytes(whole[:100])
    assert "cut before its columns" in invoke("info", recorded, code=2)


def test_repair_on_the_command_line(recorded: Path) -> None:
    recorded.write_bytes(recorded.read_bytes()[:-30])
    (row,) = json.loads(invoke("repair", recorded, "--json"))["rows"]
    new = recorded.with_name("run.repaired.mcap")
    assert (row["file"], row["rows"], row["events"], row["lost_rows"]) == (str(new), 200, 1, 1)
    assert read(new).condition.complete
    assert "there is such a file" in invoke("repair", recorded, code=2)
    assert "200 rows" in invoke("repair", recorded, "--out", recorded.with_name("b.mcap"))


def test_export_to_every_format(kind: str, recorded: Path) -> None:
    out = recorded.with_name(f"out{kind}")
    (row,) = json.loads(invoke("export", recorded, out, "--json"))["rows"]
    assert (row["rows"], row["bytes"]) == (200, out.stat().st_size)
    assert "--force" in invoke("export", recorded, out, code=2)
    assert "51 rows" in invoke("export", recorded, out, "--from", 0.1, "--to", 0.1515, "--force")


def test_export_refuses(recorded: Path) -> None:
    assert "must end in" in invoke("export", recorded, "out.xls", code=2)
    assert "no such file" in invoke("export", "none.mcap", recorded.with_name("a.csv"), code=2)
    turned = invoke("export", recorded, recorded.with_name("b.csv"), "--from", 3, "--to", 2, code=2)
    assert "--to = 2 s: must be larger than --from, 3 s" in turned
    refused = invoke("export", recorded, recorded.with_name("a.csv"), "--from", 7, code=2)
    assert "the log has 0 to 0.2 s" in refused
    assert not recorded.with_name("a.csv").exists()
    missing = recorded.parent / "no folder" / "a.csv"
    assert "there is no folder" in invoke("export", recorded, missing, code=2)
    assert "no rows before -1 s" in invoke(
        "export", recorded, recorded.with_name("a.csv"), "--to", -1, code=2
    )
    assert "x.csv: must end in .mcap" in invoke("repair", recorded, "--out", "x.csv", code=2)
    assert "cannot be written" in invoke(
        "repair", recorded, "--out", missing.with_suffix(".mcap"), code=2
    )


@pytest.mark.parametrize(
    ("command", "option", "file"),
    [("export", "", "x.csv"), ("repair", "--out", "x.mcap"), ("plot", "--out", "x.png")],
)
def test_a_file_that_cannot_be_written_is_named_with_the_remedy(
    recorded: Path, command: str, option: str, file: str
) -> None:
    out = f"/proc/{file}"
    said = invoke(command, recorded, *filter(None, (option, out)), code=2)
    wanted = "cannot be written (No such file or directory); give another file"
    assert f"{option or 'OUT'} {out}: {wanted}" in said


def test_a_log_without_rows_is_told_and_exported(tmp_path: Path) -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.1), "ebac")
    path = tmp_path / "none.mcap"
    trace[:0.0].save(path)
    assert json.loads(invoke("info", path, "--json"))["log_rows"] == 0
    assert "none" in invoke("info", path)
    assert "0 rows" in invoke("export", path, tmp_path / "none.csv")
    assert len(ebac.load(tmp_path / "none.csv")) == 0
    assert "at least 2" in invoke("plot", path, code=2)


def test_plot_draws_the_figure_or_columns(recorded: Path) -> None:
    assert "run.png" in invoke("plot", recorded)
    assert recorded.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    out = recorded.with_name("two.svg")
    invoke(
        "plot",
        recorded,
        "-c",
        "x",
        "-c",
        "v",
        "-c",
        "tick",
        "-c",
        "x",
        "--from",
        0.05,
        "--out",
        out,
    )
    assert "<svg" in out.read_text()
    assert "no column is called 'speed'" in invoke("plot", recorded, "-c", "speed", code=2)
    assert "must end in .png" in invoke("plot", recorded, "--out", "a.txt", code=2)
    assert "at least 2" in invoke("plot", recorded, "--from", 0.1995, code=2)


def test_wall_writes_logs(tmp_path: Path) -> None:
    words = ["wall", "--seconds", "0.2", "--no-files", "--json"]
    result = runner.invoke(app, [*words, "-l", "tca", "--log", str(tmp_path / "one.mcap")])
    assert result.exit_code == 0, result.output
    assert read(tmp_path / "one.mcap").trace.law == "tca"
    result = runner.invoke(
        app, [*words, "-l", "tca", "-l", "ebac", "--log", str(tmp_path / "a.csv")]
    )
    assert result.exit_code == 0, result.output
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "a-ebac.csv",
        "a-tca.csv",
        "one.mcap",
    ]
    for bad in ("a.xls", str(tmp_path / "none" / "a.mcap")):
        result = runner.invoke(app, [*words, "--log", bad])
        assert result.exit_code == 2


def test_events_of_people_are_shown_as_they_are(recorded: Path) -> None:
    event = Event(kind="note", message="a [bold] word", tick=1, t=0.0)
    assert Event.from_json(event.to_json(0)) == event
    with pytest.raises(ValueError, match="not an event"):
        Event.from_json(b"[]")


@pytest.mark.parametrize(
    ("extension", "library"),
    [("npz", "numpy"), ("csv", "numpy"), ("parquet", "pyarrow"), ("mat", "scipy"), ("h5", "h5py")],
)
@pytest.mark.parametrize("device", ["reference", "joystick"])
def test_every_format_that_is_written_is_read(
    tmp_path: Path, extension: str, library: str, device: str
) -> None:
    pytest.importorskip(library)
    scenario = ebac.Scenario(device=ebac.presets.device(device), seconds=0.05)
    trace = ebac.simulate(scenario, "ebac")
    file = tmp_path / f"run.{extension}"
    trace.save(file)
    log = ebac.logs.read(file)
    assert set(log.trace) == set(trace)
    for name in trace:
        np.testing.assert_array_equal(log.trace[name], trace[name], err_msg=name)
        assert log.trace.columns[name].unit == trace.columns[name].unit
    assert log.gaps == []
    assert log.faults == []
    assert extension == "csv" or log.trace.scenario == scenario
    assert extension == "csv" or log.trace.law == "ebac"
    assert f"run.{extension}" in invoke("info", file)


@pytest.mark.parametrize(
    ("extension", "library"), [("parquet", "pyarrow"), ("mat", "scipy"), ("h5", "h5py")]
)
def test_a_file_of_another_kind_is_refused(tmp_path: Path, extension: str, library: str) -> None:
    pytest.importorskip(library)
    file = tmp_path / f"run.{extension}"
    file.write_bytes(b"no such file at all" * 50)
    assert f"run.{extension}: not a" in invoke("info", file, code=2)


@pytest.mark.parametrize(
    ("extension", "library"), [("npz", "numpy"), ("mat", "scipy"), ("h5", "h5py")]
)
def test_a_damaged_file_is_refused_by_its_name(
    tmp_path: Path, extension: str, library: str
) -> None:
    """The error was that of zlib, SciPy or HDF5, which is no ValueError and names no file; NumPy left the file open."""
    pytest.importorskip(library)
    file = tmp_path / f"run.{extension}"
    ebac.simulate(ebac.Scenario(seconds=0.2), "ebac").save(file)
    data = bytearray(file.read_bytes())
    step = len(data) // 50
    for at in range(step, len(data), step):
        data[at] ^= 0xFF
    for damaged in (bytes(data), bytes(data[: len(data) // 2]), b"", b"\0" * 200):
        file.write_bytes(damaged)
        with pytest.raises(ValueError, match=rf"run\.{extension}: not a"):
            ebac.load(file)
        gc.collect()  # warns of a file that was not closed


@pytest.mark.parametrize(
    ("extension", "library"),
    [("npz", "numpy"), ("parquet", "pyarrow"), ("mat", "scipy"), ("h5", "h5py")],
)
def test_a_scenario_that_is_none_does_not_cost_the_rows(
    tmp_path: Path, extension: str, library: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One of another version, say; a log was read all the same, every other format refused."""
    pytest.importorskip(library)
    trace = ebac.simulate(ebac.Scenario(seconds=0.05), "ebac")
    monkeypatch.setattr(ebac.Scenario, "to_toml", lambda self: "[hand]\nmas = 1.0\n")
    trace.save(tmp_path / f"run.{extension}")
    with pytest.warns(UserWarning, match=r"the scenario in the log is not used: hand\.mas"):
        back = ebac.load(tmp_path / f"run.{extension}")
    assert back.scenario is None
    assert len(back) == len(trace)


def test_a_part_is_named_by_times(tmp_path: Path) -> None:
    start: Any = "a"
    with pytest.raises(TypeError, match="start = 'a': must be a number"):
        ebac.load(tmp_path / "run.mcap", start=start)


def test_an_empty_line_below_the_headings_is_no_end(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text("t [s],x [m]\n\n0.0,0.001\n0.001,0.002\n", encoding="utf-8")
    assert ebac.load(tmp_path / "log.csv")["x"].tolist() == [0.001, 0.002]


@pytest.mark.parametrize("rows", [1, 2, 30])
def test_a_matlab_file_comes_back_as_it_was(rows: int, tmp_path: Path) -> None:
    """On and off came back as whole numbers, which no log takes, and one row of two axes as two rows."""
    pytest.importorskip("scipy")
    device = ebac.Device(kinematics=ebac.Linear(axes=2))
    trace = ebac.simulate(ebac.Scenario(device=device, seconds=0.1), "ebac").rows(0, rows)
    trace.save(tmp_path / "run.mat")
    back = ebac.load(tmp_path / "run.mat")
    for name in trace:
        assert back[name].shape == trace[name].shape, name
        assert (back[name].dtype == bool) == (trace[name].dtype == bool), name
    back.save(tmp_path / "run.mcap")


@pytest.mark.parametrize(
    ("left_out", "says"),
    [(0, "was complete and undamaged: the new log has the same rows."), (10, "was cut: its end")],
)
def test_a_repair_says_what_was_wrong(tmp_path: Path, left_out: int, says: str) -> None:
    path = tmp_path / "run.mcap"
    ebac.simulate(ebac.Scenario(seconds=3.0), "direct").save(path)
    data = path.read_bytes()
    path.write_bytes(data[: len(data) - left_out])
    done = runner.invoke(app, ["log", "repair", str(path)])
    assert done.exit_code == 0, done.output
    assert says in " ".join(done.stdout.split())
    told = runner.invoke(app, ["log", "repair", str(path), "-o", f"{path}-2.mcap", "--json"])
    assert json.loads(told.stdout)["complete"] is (left_out == 0)
