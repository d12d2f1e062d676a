"""A law of one's own on the command line: `file.py:Name`, or `module:Name` as Python imports it."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import inspect
import sys
import traceback
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ebac.laws import AnyLaw

#: What a name with a dot, a slash or a colon may be.
FORM = (
    "a law of your own is given as FILE.py:NAME or MODULE:NAME, where NAME is a class or an object"
)

#: Files of the laws that were read, and the words on the command line that named them.
_read: dict[str, str] = {}


def own_law(word: str, option: str) -> AnyLaw:
    """Return the law that a word such as "mine.py:Mine" names.

    A class that has a classmethod `design` is designed for the device, any other is made without arguments.

    Raises
    ------
    ValueError
        When there is no such file, module or law, or when the module raises; names the option.
    """
    from ebac.laws.making import checked

    where, _, name = word.rpartition(":") if ":" in word else (word, "", "")
    if not where:
        raise ValueError(f"{option} {word}: {FORM}")
    module = _module(where, f"{option} {word}")
    if not hasattr(module, name):
        written = [
            f"{where}:{one}" for one, value in vars(module).items() if _is_law(value, module)
        ]
        has = f"its laws are {', '.join(written)}" if written else "it has no law"
        raise ValueError(f"{option} {word}: {f'{where} has no {name}; ' if name else ''}{has}")
    law: Any = getattr(module, name)
    if isinstance(law, type) and not hasattr(law, "_simulate") and not hasattr(law, "design"):
        try:
            law = law()
        except Exception as error:  # of the user's code
            raise ValueError(
                f"{option} {word}: {name}() raises {_last(error)}; give its arguments defaults, or name an object"
            ) from None
    if not isinstance(law, type):
        try:
            checked(law)
        except TypeError as error:
            raise ValueError(f"{option} {word}: {error}") from None
    return law  # type: ignore[no-any-return]


def raised_by_own(error: BaseException) -> str:
    """Return which law that was given on the command line raised an error, and where; "" when it was none."""
    files = {frame.filename for frame in traceback.extract_tb(error.__traceback__)}
    given = next((words for file, words in _read.items() if file in files), "")
    return f"{given} raises {_last(error)}" if given else ""


def _module(where: str, given: str) -> ModuleType:
    """Return the module of a file or of a name, as `_imported` does, and remember who asked for it."""
    module = _imported(where, given)
    _read[str(module.__file__)] = given
    return module


def _imported(where: str, given: str) -> ModuleType:
    """Return the module of a file or of a name. What it prints goes to stderr: stdout may be a JSON document."""
    file = Path(where)
    if file.suffix == ".py" and not file.is_file():
        raise ValueError(f"{given}: there is no file {where}")
    try:
        with contextlib.redirect_stdout(sys.stderr):
            return _of_file(file) if file.suffix == ".py" else _by_name(where)
    except ModuleNotFoundError as error:
        if error.name == where.partition(".")[0]:
            raise ValueError(f"{given}: there is no module {where}; {FORM}") from None
        raise ValueError(f"{given}: {where} raises {_last(error)}") from None
    except Exception as error:  # of the user's code
        raise ValueError(f"{given}: {where} raises {_last(error)}") from None


def _by_name(name: str) -> ModuleType:
    """Return a module that is installed, or that lies in the working folder."""
    sys.path.insert(0, str(Path.cwd()))
    return importlib.import_module(name)


def _of_file(file: Path) -> ModuleType:
    """Return a file as a module, under a name that hides no other; it can import what lies beside it."""
    name, file = f"ebac_own_{file.stem}", file.resolve()
    if name in sys.modules and sys.modules[name].__file__ == str(file):
        return sys.modules[name]  # another law of it is used as well
    sys.path.insert(0, str(file.parent))
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None  # as its name ends in .py
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # where a dataclass looks for its types
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def _is_law(value: object, module: ModuleType) -> bool:
    """Return whether a member of a module is a law that was written there, or an object that is one."""
    if inspect.isclass(value):
        written_there = value.__module__ == module.__name__
        return hasattr(value, "_simulate") or (written_there and hasattr(value, "step"))
    return hasattr(value, "step") and hasattr(value, "reset")


def _last(error: BaseException) -> str:
    """Return what an error came from, and where that was raised."""
    while error.__cause__ is not None:  # "initialization failed" of a module in C++ says nothing
        error = error.__cause__
    frames = traceback.extract_tb(error.__traceback__)
    theirs = [frame for frame in frames if frame.filename != __file__]
    at = f" ({Path(theirs[-1].filename).name}, line {theirs[-1].lineno})" if theirs else ""
    if isinstance(error, SyntaxError):
        at = f" ({Path(error.filename or '').name}, line {error.lineno})"
        return f"{type(error).__name__}: {error.msg}{at}"
    return f"{type(error).__name__}: {error}{at}"
