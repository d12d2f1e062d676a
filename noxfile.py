"""The project's chores, each in its own environment: `nox -l` lists, `nox -s tests` runs one."""

import re
from pathlib import Path

import nox

nox.options.sessions = ["lint", "types", "cpp", "tests"]
nox.options.default_venv_backend = "venv"


def cpp_sources() -> list[str]:
    roots = (Path("cpp"), Path("bindings"), Path("tests/cpp"), Path("examples"))
    return [str(p) for r in roots for p in sorted(r.rglob("*")) if p.suffix in {".hpp", ".cpp"}]


@nox.session
def tests(session: nox.Session) -> None:
    """Run the Python tests against the installed package."""
    session.install(".[test]")
    session.run("pytest", *session.posargs)


@nox.session
def lint(session: nox.Session) -> None:
    """Check formatting and style of Python and C++; `nox -s lint -- fix` repairs what it can."""
    session.install(".[dev]")
    fix = "fix" in session.posargs
    session.run("ruff", "format", *([] if fix else ["--check"]))
    session.run("ruff", "check", *(["--fix"] if fix else []))
    session.run("clang-format", *(["-i"] if fix else ["--dry-run", "-Werror"]), *cpp_sources())
    session.run(".ci/tidy", external=True)


@nox.session
def types(session: nox.Session) -> None:
    """Check the types of the Python package."""
    session.install(".[dev,test]")
    session.run("mypy")


@nox.session
def cpp(session: nox.Session) -> None:
    """Run the C++ tests, plain and under the sanitizers; `-- asan` runs one preset."""
    session.install("cmake", "ninja", "cmeel-eigen")
    for preset in session.posargs or ["default", "asan", "tsan"]:
        session.run("cmake", "--workflow", "--preset", preset)


def repair_native_enums(stub: str) -> str:
    """Keep of each enum docstring and members, as mypy wants them; pybind11-stubgen does not yet."""
    return re.sub(
        r'^(class \w+\(enum\.\w+\):\n(?:    """\n(?:    .*\n)+?    """\n)?)((?:    .*\n)+)',
        lambda c: (
            c[1] + re.sub(r"^    (?:(\w+): typing\.ClassVar.*|.*)\n", member, c[2], flags=re.M)
        ),
        stub,
        flags=re.M,
    )


#: Types of Python that the docstrings of the compiled module cannot name, by what the generator writes.
TYPES = {
    r"^class _Law:\n(?:(?:    .*)?\n)+": "",
    r"\(_Law\)": "",
    r"\b_Law\b": "ebac.laws.CoreLaw",
    r"(def _(?:replay|simulate)_python\((?:.*\n)*?.*?law: )typing\.Any": r"\1ebac.laws.PythonLaw",
    r"(configuration: )typing\.Any": r"\1ebac.hardware.Configuration | str | os.PathLike[str]",
    r"(model: )typing\.Any( = None)": r"\1ebac.hands.AnyModel\2",
    r"(def model\(self\) -> )typing\.Any": r"\1ebac.hands.AnyModel",
    r"(def __enter__\(self\) -> )typing\.Any": r"\1typing.Self",
    r"(def start\(self, .*\) -> )typing\.Any": r"\1typing.Self",
    r"^import ebac\.hardware$": "import os\nimport ebac.hands\nimport ebac.hardware\nimport ebac.laws",
}


def name_types(stub: str) -> str:
    """Write the types in that `TYPES` has."""
    for found, wanted in TYPES.items():
        stub = re.sub(found, wanted, stub, flags=re.M)
    return stub


def member(line: re.Match[str]) -> str:
    return f"    {line[1]} = ...\n" if line[1] else ""


@nox.session
def stubs(session: nox.Session) -> None:
    """Write python/ebac/_core.pyi anew from the compiled module."""
    session.install(".[dev]")
    out = Path(session.create_tmp())
    bare = "import ebac._util.wrong_calls as own; own.wrap_members = id"  # which hides signatures
    generate = f"{bare}; from pybind11_stubgen import main; main()"
    session.run("python", "-c", generate, "ebac._core", "--output-dir", str(out), "--exit-code")
    stub = Path("python/ebac/_core.pyi")
    generated = (out / "ebac" / "_core.pyi").read_text()
    stub.write_text(name_types(repair_native_enums(generated)))
    session.run("ruff", "check", "--fix-only", "--quiet", str(stub))
    session.run("ruff", "format", str(stub))
