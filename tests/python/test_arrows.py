"""Who may include whom.

core <- model <- control <- loop <- { sim | rt <- sensor | rt <- can <- canopen <- simulated_drives }
    <- bindings <- python, and rt <- world <- bindings: the loop knows its interface, which is the model's
"""

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import ebac
from ebac import _core

ROOT = Path(__file__).parents[2]
CPP = ROOT / "cpp" / "ebac"
PACKAGE = Path(ebac.__file__).parent

#: What each folder may include besides itself.
MAY_SEE = {
    "core": set(),
    "model": {"core"},
    "world": {"core", "model", "loop", "rt"},  # the mailbox, and memory shared with another process
    "control": {"core", "model"},
    "identify": {"core", "model"},
    "loop": {"core", "model", "control"},
    "sim": {"core", "model", "control", "loop"},
    "gastroscope": {"core", "model", "world", "control", "loop", "sim"},
    "rt": {"core", "model", "control", "loop"},
    "can": {"core", "rt"},
    "canopen": {"core", "model", "loop", "can"},
    "simulated_drives": {"core", "model", "control", "loop", "rt", "can", "canopen"},
    "sensor": {"core", "model", "control", "loop", "rt"},
    "portable": {"core", "can", "rt", "sensor"},
    "teleop": {"core", "model", "control", "loop", "sim", "sensor"},
    "remote": {"core", "model", "loop", "sensor", "teleop", "gastroscope"},
    "faults": {"core", "model", "control", "loop", "sim", "can", "canopen", "simulated_drives"},
}

#: Nothing that allocates, locks or prints is known where a tick runs, but for
SLOW = {
    *("vector", "string", "map", "unordered_map", "list", "deque", "set", "memory", "functional"),
    *("iostream", "sstream", "fstream", "iomanip", "format", "stdexcept"),
    *("mutex", "thread", "future", "condition_variable"),
}
#: what checks parameters, before the loop, by exceptions that name them.
EXCEPTIONS = {
    "core/check.hpp": {"string"},
    # A law of any type lies on the heap: it is made and copied before the loop.
    "control/any_law.hpp": {"memory"},
    "control/law_type.hpp": {"memory"},
    # So does a world of any kind, of which each run has a copy.
    "model/environment.hpp": {"memory"},
    "model/world.hpp": {"memory"},
}

SOURCES = sorted(CPP.rglob("*.[hc]pp"))


@cache
def includes(path: Path) -> list[str]:
    return re.findall(
        r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', path.read_text(encoding="utf-8"), re.MULTILINE
    )


def own(path: Path) -> list[str]:
    return [name.removeprefix("ebac/") for name in includes(path) if name.startswith("ebac/")]


def reached(start: list[Path]) -> set[Path]:
    found, left = set(), start
    while left:
        path = left.pop()
        if path not in found:
            found.add(path)
            left += [CPP / name for name in own(path)]
    return found


def included() -> Iterator[tuple[str, str, Path]]:
    """Yield every file, what it includes, and the file's path; one test for all files, as there are hundreds."""
    for path in SOURCES:
        for name in includes(path):
            yield f"{path.relative_to(CPP)} includes {name}", name, path


def test_includes_point_leftwards_only() -> None:
    for told, full, path in included():
        if full.startswith("ebac/"):
            name = full.removeprefix("ebac/")
            folder = path.relative_to(CPP).parts[0]
            assert name.split("/")[0] in MAY_SEE[folder] | {folder}, told
            assert (CPP / name).is_file(), told


def test_the_core_knows_no_python_and_prints_nothing() -> None:
    for told, name, _ in included():
        assert not name.startswith("pybind11"), told
        assert name not in {"Python.h", "iostream", "cstdio", "print"}, told


def test_own_headers_are_included_by_their_full_name() -> None:
    for told, name, path in included():
        assert not (CPP / name).exists(), f"{told}: write ebac/{name}"
        assert not (path.parent / name).exists(), f"{told}: write its path from ebac/"


def test_types_are_named_by_using() -> None:
    """clang-tidy's modernize-use-using looks through every header of the system, a tenth of its time."""
    sources = [
        path for top in ("cpp", "bindings", "tests/cpp") for path in (ROOT / top).rglob("*.[hc]pp")
    ]
    assert len(sources) > 300
    assert not [p for p in sources if re.search(r"\btypedef\b", p.read_text(encoding="utf-8"))]


def test_no_folder_is_forgotten() -> None:
    assert {path.name for path in CPP.iterdir() if path.is_dir()} <= set(MAY_SEE)
    assert len(list(CPP.rglob("*.hpp"))) > 30


def test_includes_make_no_circle() -> None:
    order: list[Path] = []
    open_: list[Path] = []

    def visit(path: Path) -> None:
        assert path not in open_, " -> ".join(p.name for p in [*open_, path])
        if path in order:
            return
        open_.append(path)
        for name in own(path):
            visit(CPP / name)
        order.append(open_.pop())

    for path in CPP.rglob("*.hpp"):
        visit(path)


def test_a_file_includes_what_it_names() -> None:
    """A bundle compiles several files as one, and so hides what one of them leaves out."""
    left_out = r'//.*|"(\\.|[^"\\\n])*"|^\s*#\s*include.*'
    code = {
        path: re.sub(left_out, "", path.read_text(encoding="utf-8"), flags=re.M) for path in SOURCES
    }
    scope = {
        path: "".join(re.findall(r"^namespace (ebac[\w:]*)", text, re.M)[:1])
        for path, text in code.items()
    }
    types = r"(?:class|struct|enum class|concept) ([A-Z]\w+)(?: final)?(?=[ :;]*[{:=])"
    defined = re.compile(rf"^(?:{types}|using ([A-Z]\w+) =|#define ([A-Z]\w+))", re.M)
    within = re.compile(r"\b(?:class|struct|typename|using|concept) ([A-Z]\w+)")
    inner = {path: set(within.findall(text)) for path, text in code.items()}
    homes: dict[str, set[Path]] = {}
    for path in CPP.rglob("*.hpp"):
        for found in defined.findall(code[path]):
            homes.setdefault("".join(found), set()).add(path)
    assert len(homes) > 200
    wrong = []
    for path in SOURCES:
        seen = reached([path])
        known = set().union(*(inner[other] for other in seen))
        for name in set(re.findall(r"(?<![:.])\b[A-Z]\w+", code[path])) & set(homes):
            places = {home for home in homes[name] if scope[path].startswith(scope[home])}
            if places and not places & seen and name not in known:
                wrong.append(f"{path.relative_to(CPP)}: {name}, {min(places).relative_to(CPP)}")
    assert not wrong


def test_the_headers_of_a_tick_know_nothing_slow() -> None:
    on_path = reached([CPP / "loop" / "tick.hpp", *(CPP / "control").glob("*.hpp")])
    assert len(on_path) > 20
    found = {
        path.relative_to(CPP).as_posix(): slow
        for path in on_path
        if (slow := SLOW & set(includes(path)))
    }
    assert found == EXCEPTIONS


def test_laws_know_of_the_model_only_what_has_no_state_of_the_world() -> None:
    """A law is designed from what is known of the device, never from hand or wall."""
    for path in reached(list((CPP / "control").glob("*.hpp"))):
        assert path.name not in {"hand.hpp", "environment.hpp", "device.hpp"}, path


# --- Python ---


def imports(path: Path) -> set[str]:
    """Full names of what a module imports, at its top or inside functions."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.name}: import by the full name"
            found |= {f"{node.module}.{name.name}" for name in node.names}
    return found


def modules(name: str) -> list[Path]:
    return (
        [PACKAGE / f"{name}.py"]
        if (PACKAGE / f"{name}.py").exists()
        else sorted((PACKAGE / name).glob("*.py"))
    )


#: The rooms of the package: each may import, at the top of a file, the rooms before it.
#: What a method needs to show its result (`trace.plot()`) it imports when it is called.
ROOMS = [
    *(
        "_util",
        "presets",
        "laws",
        "specs",
        "hands",
        "operators",
        "worlds",
        "scenario_text",
        "scenario_checks",
        "scenario",
        "trace",
        "simulation",
        "metrics",
        "gastroscope",
    ),
    *("drives", "can", "sensor", "realtime", "logs", "hardware", "faults"),
    *(
        "studies",
        "teleop",
        "tracking",
        "plot",
        "explore",
        "live",
        "identify",
        "testing",
        "peers",
        "paper",
        "datasets",
        "cli",
        "__main__",
    ),
]


def imported_rooms(path: Path) -> set[str]:
    """Rooms a file imports at its top; not those for types only."""
    found = set()
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "ebac":
            parts = (node.module or "").split(".")
            found |= {parts[1]} if len(parts) > 1 else {name.name for name in node.names}
    return found - {"_core"}


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_imports_only_rooms_before_it(room: str) -> None:
    place = PACKAGE / room
    files = sorted(place.rglob("*.py")) if place.is_dir() else [place.with_suffix(".py")]
    assert files
    allowed = {*ROOMS[: ROOMS.index(room) + 1]}
    wrong = {
        f"{path.relative_to(PACKAGE)} imports ebac.{name}"
        for path in files
        for name in imported_rooms(path) - allowed
    }
    assert not wrong


def test_no_room_is_forgotten() -> None:
    rooms = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    rooms |= {path.stem for path in PACKAGE.glob("*.py") if path.stem != "__init__"}
    assert rooms == set(ROOMS)


LOOP = {"Rows", "Setup", "Column", "ExactPlant", "SteppedPlant", "_simulate_python"}


@pytest.mark.parametrize("name", ["metrics", "plot"])
def test_what_looks_at_a_trace_sees_no_loop(name: str) -> None:
    paths = modules(name)
    assert paths
    for path in paths:
        found = imports(path)
        assert not {f"ebac._core.{part}" for part in LOOP} & found, path
        assert not {f"ebac._core.{law.__name__}" for law in ebac.LAWS.values()} & found, path
        assert "ebac._core" not in found, path
        assert "ebac.simulation.simulate" not in found, path
        assert "ebac.simulate" not in found, path
        assert "_simulate" not in path.read_text(encoding="utf-8"), path


def test_the_names_of_the_loop_are_those_of_the_core() -> None:
    for name in LOOP:
        assert hasattr(_core, name), name


def test_drives_know_nothing_of_the_loop() -> None:
    """They work on a laptop beside the machine."""
    paths = modules("drives")
    assert len(paths) > 10
    lengths = ("_exact_bits", "least_bits", "worst_bits", "WARNED_LOAD", "REFUSED_LOAD")
    wire = ("SimulatedWire", "TimedBus")  # stations, frames and times: no drive, no loop
    watches = ("_beat_period", "_check_watch")  # times alone
    frames = {f"ebac._core.{name}" for name in (*lengths, *wire, *watches)}
    for path in paths:
        core = {name for name in imports(path) if name.startswith("ebac._core.")}
        assert core <= frames, path
        assert not {"ebac.simulation.simulate", "ebac.simulate"} & imports(path), path


def test_importing_the_package_loads_nothing_heavy() -> None:
    heavy = [
        "matplotlib",
        "pandas",
        "scipy",
        "typer",
        "rich",
        "tomli_w",
        "can",
        "canopen",
        "mcap",
        "zstandard",
        "h5py",
    ]
    code = (
        f"import ebac, ebac.drives, sys; print([name for name in {heavy} if name in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert run.stdout.strip() == "[]"


def test_only_the_bindings_know_pybind11() -> None:
    for path in (ROOT / "bindings").glob("*.[hc]pp"):
        for name in includes(path):
            assert not name.startswith("../"), name
    assert any(
        "pybind11/pybind11.h" in includes(path) for path in (ROOT / "bindings").glob("*.hpp")
    )
