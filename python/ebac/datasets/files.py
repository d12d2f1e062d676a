"""The data sets as files: what each is for, how it is written, and which command to try next."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from ebac._util.arguments import named, require_path
from ebac._util.atomic_file import draft
from ebac.datasets import logs, others

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ebac.trace import Trace


@dataclass(frozen=True, kw_only=True)
class Dataset:
    """A data set that can be written to a file.

    Attributes
    ----------
    name : str
        Name for `ebac demo` and `write`.
    file : str
        Name of the file.
    about : str
        What it contains.
    truth : str
        The true values behind the simulation; empty where there are none.
    commands : tuple of str
        Commands to try with the file.
    data : bool
        Whether it contains data, which are simulated.
    """

    name: str
    file: str
    about: str
    truth: str = ""
    commands: tuple[str, ...]
    data: bool = True
    _write: Callable[[Path, str], None]

    @property
    def note(self) -> str:
        """Note in the file: origin, content, true values."""
        from ebac import __version__
        from ebac._util.text_file import SIMULATED

        if not self.data:
            return self.about
        truth = f" True values: {self.truth}." if self.truth else ""
        return f"{SIMULATED} {__version__}, not measured. {self.about}{truth}"


def write(name: str, folder: str | Path = ".", *, force: bool = False) -> Path:
    """Write a data set to a file and return its path.

    Parameters
    ----------
    name : str
        One of `DATASETS`.
    folder : str or Path
        Where to; made if it does not exist.
    force : bool
        Replace a file of that name with other content.

    Raises
    ------
    KeyError
        For an unknown name.
    FileExistsError
        When another file of that name exists and `force` is false.
    """
    known = named("data set", name, DATASETS)
    require_path(folder, "ebac.datasets.write", "the path of a folder")
    target = Path(folder) / known.file
    target.parent.mkdir(parents=True, exist_ok=True)
    with draft(target) as new, TemporaryDirectory(prefix=".demo-", dir=target.parent) as beside:
        made = Path(beside) / known.file
        known._write(made, known.note)
        if target.exists() and not force and target.read_bytes() != made.read_bytes():
            raise FileExistsError(17, "a file of that name exists", str(target))
        new.write_bytes(made.read_bytes())
    return target


def _csv(make: Callable[[], Trace], columns: Mapping[str, str]) -> Callable[[Path, str], None]:
    """Return what writes the named columns of a trace, under other headings, below a comment."""

    def made(path: Path, note: str) -> None:
        trace = make()
        rows = zip(*([repr(round(v, 12)) for v in trace[c].tolist()] for c in columns), strict=True)
        _table(path, note, list(columns.values()), map(",".join, rows))

    return made


def _path(make: Callable[[], NDArray[np.float64]]) -> Callable[[Path, str], None]:
    def made(path: Path, note: str) -> None:
        rows = (f"{1e3 * x:.6f},{1e3 * y:.6f}" for x, y in make().tolist())
        _table(path, note, ["x [mm]", "y [mm]"], rows)

    return made


def _table(path: Path, note: str, headings: list[str], rows: Iterable[str]) -> None:
    lines = [f"# {note}", ",".join(headings), *rows, ""]
    path.write_text("\n".join(lines), encoding="utf-8")


def _mcap(make: Callable[[], Trace]) -> Callable[[Path, str], None]:
    def made(path: Path, note: str) -> None:
        from ebac.logs.files import write_mcap

        write_mcap(make(), path, files={"README.txt": note + "\n"})

    return made


def _hands(path: Path, note: str) -> None:
    others.hands().to_csv(path)
    path.write_text(f"# {note}\n{path.read_text(encoding='utf-8')}", encoding="utf-8")


def _joystick(path: Path, note: str) -> None:
    path.write_text(others.joystick_text(path.stem), encoding="utf-8")


def _configuration(name: str, about: str, command: str = "") -> Dataset:
    """Return a configuration for drives, by default one that `ebac run` takes."""
    file = f"{name}.toml"
    return Dataset(
        name=name,
        file=file,
        about=about,
        data=False,
        commands=(command or f"ebac run {file} --simulated",),
        _write=_joystick,
    )


def _engine(path: Path, note: str) -> None:
    path.write_text(
        Path(__file__).with_name("engine.py").read_text(encoding="utf-8"), encoding="utf-8"
    )


_HAND = {"t": "t [s]", "x": "x [m]", "f_meas": "force [N]", "f_applied": "motor [N]"}

#: Every data set by its name.
DATASETS: dict[str, Dataset] = {
    known.name: known
    for known in (
        Dataset(
            name="arm",
            file="arm.csv",
            about="A hand holds the handle while the motor pushes it; 10 s at 1 kHz.",
            truth="M0 = 0.35 kg, B0 = 6 N s/m, K0 = 300 N/m",
            commands=("ebac identify arm arm.csv",),
            _write=_csv(logs.arm, _HAND),
        ),
        Dataset(
            name="tapping",
            file="tapping.mcap",
            about="A hand taps at a virtual wall 0.8 times a second; 10 s at 1 kHz.",
            truth="M0 = 0.35 kg, B0 = 6 N s/m, K0 = 300 N/m",
            commands=(
                "ebac identify arm tapping.mcap",
                "ebac log info tapping.mcap",
            ),
            _write=_mcap(logs.tapping),
        ),
        Dataset(
            name="device",
            file="device.csv",
            about="A hand moves a device with friction to and fro; 5 s at 1 kHz.",
            truth="mass 0.25 kg, damping 3 N s/m, Coulomb friction 0.4 N, weight 0.228 N",
            commands=("ebac identify device device.csv",),
            _write=_csv(logs.device, _HAND),
        ),
        Dataset(
            name="press",
            file="press.csv",
            about="A hand presses into a virtual wall from t = 1 s on; 4 s at 1 kHz.",
            truth="M0 = 0.15 kg, B0 = 6 N s/m, K0 = 300 N/m",
            commands=("ebac identify gains press.csv --switch 1.0",),
            _write=_csv(logs.press, {**_HAND, "f_env": "desired [N]"}),
        ),
        Dataset(
            name="sway",
            file="sway.mcap",
            about="A hand presses on a virtual wall to and fro, once a second; 15 s at 1 kHz.",
            truth="the force sensor shows 2 % too little; friction 0.1 N",
            commands=("ebac identify scale sway.mcap",),
            _write=_mcap(logs.sway),
        ),
        Dataset(
            name="line",
            file="line.csv",
            about="A hand follows a ruler of 80 mm there and back; 400 points.",
            truth="80 mm long, at 30 deg",
            commands=("ebac track line.csv",),
            _write=_path(others.line),
        ),
        Dataset(
            name="circle",
            file="circle.csv",
            about="A hand follows a circle; 400 points.",
            truth="radius 40 mm, centre at 0, 0",
            commands=("ebac track circle.csv",),
            _write=_path(others.circle),
        ),
        Dataset(
            name="hands",
            file="hands.csv",
            about="Twelve random hands: mass, damping, stiffness and the depth each wants to reach.",
            commands=("ebac study --population hands.csv --law ebac",),
            _write=_hands,
        ),
        _configuration(
            "handle",
            "The configuration of a device with one axis, for hardware and for a simulated drive.",
        ),
        _configuration(
            "joystick",
            "The configuration of the paper's joystick, for hardware and for simulated drives.",
        ),
        _configuration(
            "joystick-3",
            "The same for three axes: its lever slides, three drives, a ball to feel.",
        ),
        Dataset(
            name="engine",
            file="engine.py",
            about="A program that computes a virtual world, a ball that breathes, for a run on drives.",
            data=False,
            commands=('ebac run joystick.toml --simulated --engine-command "python engine.py"',),
            _write=_engine,
        ),
        *(
            _configuration(
                f"gastroscope-{part}",
                f"The configuration of a teleoperated gastroscope's {what}, for real and for simulated drives.",
                command,
            )
            for part, what, command in (
                (
                    "master",
                    "joystick",
                    "ebac gastroscopy master gastroscope-master.toml --simulated --seconds 3",
                ),
                (
                    "feed",
                    "drives for insertion and rotation",
                    "ebac gastroscopy slave --feed gastroscope-feed.toml --simulated --seconds 3",
                ),
                (
                    "bend",
                    "drives for both bends",
                    "ebac gastroscopy slave --bend gastroscope-bend.toml --simulated --seconds 3",
                ),
            )
        ),
    )
}
