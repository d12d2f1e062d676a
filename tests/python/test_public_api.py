"""The public API: every name and signature in one golden file, TAB shows it, and an import loads nothing heavy."""

import ast
import enum
import inspect
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import ebac

GOLDEN = Path(__file__).parents[1] / "golden" / "public_api.txt"
STUB = Path(ebac.__file__).with_name("_core.pyi")
MODULES = {name: thing for name in dir(ebac) if inspect.ismodule(thing := getattr(ebac, name))}
#: Loaded when something of them is used, never by `import ebac`.
HEAVY = ("numpy", "matplotlib", "typer", "rich", "can", "canopen", "mcap", "pandas", "scipy")


def core_parameters() -> dict[str, str]:
    """Return the parameters of the classes and functions of the compiled module, from its stub."""
    found = {}
    for node in ast.parse(STUB.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef):
            found.setdefault(node.name, names_of(node.args))
        elif isinstance(node, ast.ClassDef):
            for part in node.body:
                if isinstance(part, ast.FunctionDef) and part.name == "__init__":
                    found.setdefault(node.name, names_of(part.args))
    return found


def names_of(given: ast.arguments) -> str:
    names = [a.arg for a in (*given.posonlyargs, *given.args) if a.arg != "self"]
    if given.vararg or given.kwonlyargs:
        names.append(f"*{given.vararg.arg}" if given.vararg else "*")
    names += [a.arg for a in given.kwonlyargs]
    return ", ".join(names + ([f"**{given.kwarg.arg}"] if given.kwarg else []))


CORE = core_parameters()


def default(value: Any) -> str:
    text = repr(value)
    return text if len(text) < 40 and not text.startswith("<") and " at 0x" not in text else "..."


def signature(thing: Any) -> str:
    """Return names, types and defaults; types as the source has them."""
    if getattr(thing, "__module__", "").startswith("ebac._core") or inspect.isbuiltin(thing):
        return f"({CORE.get(thing.__name__, '')})"
    if isinstance(thing, enum.EnumType) or getattr(thing, "_is_protocol", False):
        return ""
    parts, star = [], False
    try:
        parameters = inspect.signature(thing).parameters.values()
    except ValueError:  # a built-in type under another name
        return ""
    for p in parameters:
        if p.kind is p.KEYWORD_ONLY and not star:
            parts.append("*")
        star |= p.kind in (p.KEYWORD_ONLY, p.VAR_POSITIONAL)
        mark = {p.VAR_POSITIONAL: "*", p.VAR_KEYWORD: "**"}.get(p.kind, "")
        kind = f": {p.annotation}" if isinstance(p.annotation, str) else ""
        value = f" = {default(p.default)}" if p.default is not p.empty else ""
        parts.append(f"{mark}{p.name}{kind}{value}")
    return f"({', '.join(parts)})"


def members(cls: type) -> Iterator[str]:
    """Give the methods and properties of a class of Python, inherited ones too; those of the core are in its stub."""
    own = [base for base in cls.__mro__ if base.__module__.partition(".")[0] == "ebac"]
    for name in sorted({name for base in own for name in vars(base)}):
        thing = inspect.getattr_static(cls, name)
        if name.startswith("_") or inspect.isclass(thing):
            continue
        if isinstance(thing, (staticmethod, classmethod)):
            yield f"{name}{signature(thing.__func__)}"
        elif inspect.isfunction(thing):
            yield f"{name}{signature(thing)}"
        elif isinstance(thing, property) or type(thing).__name__ == "cached_property":
            yield name


def entries(path: str, module: ModuleType) -> Iterator[str]:
    for name in sorted(getattr(module, "__all__", dir(module))):
        thing = getattr(module, name)
        full = f"{path}.{name}"
        if inspect.ismodule(thing):
            yield f"{full} (module)"
        elif hasattr(thing, "__origin__"):  # a name for a type
            yield full
        elif inspect.isclass(thing):
            yield f"{full}{signature(thing)}"
            if thing.__module__.startswith(path) and path != "ebac":
                yield from (f"    .{text}" for text in members(thing))
        elif inspect.isroutine(thing):
            yield f"{full}{signature(thing)}"
        else:
            yield full


def api() -> list[str]:
    lines = list(entries("ebac", ebac))
    for name, module in MODULES.items():
        lines += entries(f"ebac.{name}", module)
        for part in sorted(getattr(module, "__all__", dir(module))):
            inner = getattr(module, part)
            if inspect.ismodule(inner) and hasattr(inner, "__all__"):
                lines += entries(f"ebac.{name}.{part}", inner)
    return lines


def test_the_public_api_is_the_golden_one(pytestconfig: pytest.Config) -> None:
    text = "\n".join(api()) + "\n"
    if pytestconfig.getoption("--ebac-update"):
        GOLDEN.write_text(text, encoding="utf-8")
    assert text == GOLDEN.read_text(encoding="utf-8"), (
        "if it is meant to differ: pytest tests/python/test_public_api.py --ebac-update"
    )


def test_tab_shows_the_public_names_and_nothing_else() -> None:
    shown = dir(ebac)
    assert {"simulate", "Wall", "zwidth", "logs", "studies", "__version__"} <= set(shown)
    assert not [name for name in shown if name.startswith("_") and name != "__version__"]
    for name, module in MODULES.items():
        parts = dir(module)
        assert parts, name
        assert not [part for part in parts if part.startswith("_")], name
        assert not {"np", "annotations", "Any", "dataclass"} & set(parts), name


def test_every_folder_is_public_or_private_by_its_name() -> None:
    folders = {path.parent.name for path in Path(ebac.__file__).parent.glob("*/__init__.py")}
    assert folders - {"_util", "cli"} <= set(MODULES)


def test_a_function_of_the_root_is_no_module() -> None:
    for name in (
        "study",
        "ablation",
        "worst",
        "sweep",
        "stability_map",
        "stiffest",
        "zwidth",
        "simulate",
    ):
        assert inspect.isfunction(getattr(ebac, name)), name


def test_an_unknown_name_suggests_the_nearest() -> None:
    run = subprocess.run(
        [sys.executable, "-c", "import ebac; ebac.simulat"], capture_output=True, text=True
    )
    assert (
        run.stderr.count("module 'ebac' has no attribute 'simulat'. Did you mean: 'simulate'?") == 1
    )
    assert run.stderr.count("Did you mean") == 1


@pytest.mark.parametrize(
    ("module", "given", "meant"), [(ebac, "simulat", "simulate"), (ebac.worlds, "Shpere", "Sphere")]
)
def test_the_message_itself_suggests_the_nearest(
    module: ModuleType, given: str, meant: str
) -> None:
    """A traceback adds it; notebooks and pytest show the message alone."""
    with pytest.raises(AttributeError) as refused:
        getattr(module, given)
    assert str(refused.value).endswith(f"has no attribute '{given}'. Did you mean: '{meant}'?")
    with pytest.raises(AttributeError, match=r"has no attribute 'qqqqqq'$"):
        module.qqqqqq  # noqa: B018


def test_an_import_loads_nothing_heavy(capsys: pytest.CaptureFixture[str]) -> None:
    code = (
        "import sys, time; wall, cpu = time.perf_counter(), time.process_time(); import ebac; "
        "print(time.perf_counter() - wall, time.process_time() - cpu, *sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    wall, cpu, *loaded = run.stdout.split()
    with capsys.disabled():
        print(
            f"\nimport ebac: {1e3 * float(wall):.0f} ms, of the processor {1e3 * float(cpu):.0f} ms"
        )
    assert not set(HEAVY) & set(loaded)
    own = {name for name in loaded if name.split(".")[0] == "ebac"}
    assert own == {"ebac", "ebac._util", "ebac._util.lazy", "ebac._util.parent"}
