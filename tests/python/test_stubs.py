"""`_core.pyi` says what the compiled module has: names, parameters, what is writable; both ways.

Read from the signatures that pybind11 writes into docstrings, so the test needs no stub generator.
After a change of the bindings, `nox -s stubs` writes the stub anew.
"""

import ast
import enum
import re
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import ebac
from ebac import _core

# Name -> "class", "value", "read-only", "read-write" or the parameter names of each overload.
Description = dict[str, object]


def public(name: str) -> bool:
    return not name.startswith("_") or name in {"__init__", "__call__", "__len__", "__getitem__"}


# --- the compiled module ---


def split(parameters: str) -> Iterator[str]:
    """Cut `a: dict[str, int], b: float = 1` at its outermost commas."""
    depth, start = 0, 0
    for i, c in enumerate(parameters):
        depth += (c in "([{<") - (c in ")]}>" and parameters[i - 1] != "-")
        if c == "," and depth == 0:
            yield parameters[start:i]
            start = i + 1
    yield parameters[start:]


def signatures(name: str, doc: str | None) -> list[list[str]]:
    """Parameter names of each overload, from the docstring of a bound function."""
    lines = (doc or "").splitlines()
    overloaded = "Overloaded function." in lines[:3]
    head = re.compile((r"\d+\. " if overloaded else "") + re.escape(name) + r"\((.*)\)( -> .*)?$")
    found = [m[1] for line in (lines if overloaded else lines[:1]) if (m := head.match(line))]
    return sorted([re.split("[:=]", p)[0].strip() for p in split(s)] if s else [] for s in found)


def module_members(owner: ModuleType | type, prefix: str = "") -> Description:
    if isinstance(owner, type) and issubclass(owner, enum.Enum):
        return {prefix + name: "value" for name in owner.__members__}
    found: Description = {}
    for name, value in vars(owner).items():
        if not public(name) or isinstance(value, ModuleType):
            continue
        if isinstance(value, type):
            found[prefix + name] = "class"
            found |= module_members(value, f"{prefix}{name}.")
        elif isinstance(value, property):
            found[prefix + name] = "read-write" if value.fset else "read-only"
        elif isinstance(value, staticmethod) or callable(value):
            told = signatures(name, getattr(owner, name).__doc__)
            if name != "__init__" or told:  # else Python's own: nobody can make one
                found[prefix + name] = told
        else:
            found[prefix + name] = "value"
    return found


# --- the stub ---


def parameters(function: ast.FunctionDef) -> list[str]:
    a = function.args
    names = [p.arg for p in a.posonlyargs] + (["/"] if a.posonlyargs else [])
    names += [p.arg for p in a.args]
    if a.vararg:
        names.append(f"*{a.vararg.arg}")
    elif a.kwonlyargs:
        names.append("*")
    names += [p.arg for p in a.kwonlyargs]
    return names + ([f"**{a.kwarg.arg}"] if a.kwarg else [])


def stub_members(body: list[ast.stmt], prefix: str = "") -> Description:
    found: Description = {}
    for node in body:
        match node:
            case ast.ClassDef() if public(node.name):
                found[prefix + node.name] = "class"
                found |= stub_members(node.body, f"{prefix}{node.name}.")
            case ast.FunctionDef() if public(node.name):
                key = prefix + node.name
                decorators = {ast.unparse(d) for d in node.decorator_list}
                if "property" in decorators:
                    found[key] = "read-only"
                elif f"{node.name}.setter" in decorators:
                    found[key] = "read-write"
                else:
                    overloads = found.setdefault(key, [])
                    assert isinstance(overloads, list), f"{key} is defined twice"
                    found[key] = sorted([*overloads, parameters(node)])
            case ast.AnnAssign(target=ast.Name(id=name)) | ast.Assign(targets=[ast.Name(id=name)]):
                if public(name):
                    found[prefix + name] = "value"
    return found


def test_stub_and_module_agree() -> None:
    stub = Path(ebac.__file__).with_name("_core.pyi")
    expected = module_members(_core)
    assert expected, "the compiled module has no public names"
    assert stub_members(ast.parse(stub.read_text()).body) == expected, "run `nox -s stubs`"


def test_package_is_marked_as_typed() -> None:
    assert Path(ebac.__file__).with_name("py.typed").is_file()
