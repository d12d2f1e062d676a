"""Names given to a command, in lists and in any case: laws, conditions, hands, devices."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from ebac._util.arguments import unknown
from ebac.cli import doubtful
from ebac.cli.own_law import FORM, own_law

if TYPE_CHECKING:
    from ebac.laws import AnyLaw

#: What follows where a law looks like a file or a class, of a command that takes the package's laws only.
_OWN_LAW = (
    "; this command takes the laws of the package only. A law of your own, FILE.py:NAME, is taken by --law of "
    "`ebac wall`, `ebac study`, `ebac stiffest` and others that simulate: see docs/how-to/write_a_law.md"
)


def one_law(name: str, option: str = "--law", own: str = _OWN_LAW) -> str:
    """Return a law by its name, in any case, where there can be one only; `own` as in `law_names`."""
    names = law_names([name], option, own)
    if len(names) != 1:
        raise ValueError(f"{option} {name}: one law only; give one of {', '.join(names)}")
    return names[0]


def any_law(word: str, option: str = "--law", *, python: bool = False) -> AnyLaw:
    """Return the one law that a name, or a word such as "my_laws:Damped", stands for.

    One in `python` where a command takes that: such a command simulates many runs.
    """
    if _is_own(word) and "," not in word:
        from ebac.laws.making import IN_PYTHON

        law = own_law(word, option)
        if not (python or hasattr(law, "_simulate")):
            raise ValueError(f"{option} {word}: {IN_PYTHON}")
        _note_slow(law, f"{option} {word}")
        return law
    return one_law(word, option, own=f"; {FORM}")


def designed_law(word: str, where: str) -> AnyLaw:
    """Return a law as `any_law` does, `where` none has tuned parameters; each is designed for the device there."""
    from ebac.laws.tuned_laws import tuned_laws

    law, tuned, _ = word.lower().replace("_", "-").partition("-tuned")
    if tuned and any(one.startswith(f"{law}-tuned") for one in tuned_laws()):
        raise ValueError(f"--law {word}: {where} has no laws with tuned parameters; give {law}")
    return any_law(word)


def law_names(given: Sequence[str], option: str = "--law", own: str = _OWN_LAW) -> list[str]:
    """Return the laws of names in any case, separated by commas, each once, in the order given; `all` is every law.

    `own` is what follows where a law looks like a file or a class.
    """
    from ebac.laws import LAWS
    from ebac.laws.tuned_laws import tuned_laws

    known = (*LAWS, *tuned_laws())
    names: list[str] = []
    for word in _words(given, option):
        name = word.lower().replace("_", "-")
        if name not in known and name != "all":
            hint = own if re.search(r"[.:/]", word) else ""
            raise ValueError(unknown(f"{option} {word}", name, [*known, "all"], "law") + hint)
        names += LAWS if name == "all" else [name]
    chosen = list(dict.fromkeys(names))
    _note_tuned([name for name in chosen if name not in LAWS])
    return chosen


def laws(given: Sequence[str], option: str = "--law", *, many: bool = False) -> dict[str, AnyLaw]:
    """Return laws by their names in tables: those of `law_names`, and laws of one's own, `file.py:Name`.

    `many` is whether the command simulates many runs, in which a law in Python takes its time.

    Raises
    ------
    ValueError
        For a name that is no law, or a law of one's own whose name another has.
    """
    from ebac.laws import LAWS, law_name

    found: dict[str, AnyLaw] = {}
    for word in dict.fromkeys(_words(given, option)):
        if not _is_own(word):
            found |= {name: name for name in law_names([word], option, own=f"; {FORM}")}
            continue
        law = own_law(word, option)
        name = law_name(law)
        if name in LAWS or name in found:
            raise ValueError(
                f"{option} {word}: its name is {name}, as that of another law; give its class another `name`, or, of "
                "several objects of one class, each a `name` of its own"
            )
        if many:
            _note_slow(law, f"{option} {word}")
        found[name] = law
    return found


def own_words(given: Sequence[str], option: str = "--law") -> dict[str, str]:
    """Return how laws of one's own were given on the command line, by their names in tables."""
    from ebac.laws import law_name

    words = filter(_is_own, _words(given, option))
    return {law_name(own_law(word, option)): word for word in words}


def _is_own(word: str) -> bool:
    return ":" in word or word.endswith(".py")


def _note_slow(law: AnyLaw, given: str) -> None:
    """Say on stderr that many runs of a law take their time where it is written in Python."""
    from ebac.cli import output

    if not hasattr(law, "_simulate"):
        output.note(
            f"{given}: is written in Python, so that a run takes about ten times as long as one of a compiled law, and "
            "no two of them run at the same time; simulate less first, or write it in C++ (docs/how-to/write_a_law.md)"
        )


def _note_tuned(names: Sequence[str]) -> None:
    """Say on stderr what a law with tuned parameters is."""
    from ebac.cli import output
    from ebac.laws.tuned_laws import tuned_text

    for name in names:
        output.note(tuned_text(name))


def _words(given: Sequence[str], option: str) -> list[str]:
    """Return the names of lists separated by commas."""
    names = [word.strip() for text in given for word in text.split(",")]
    for name in names:
        if " " in name:
            raise ValueError(
                f"{option} {name}: separate names by commas: {option} {','.join(name.split())}"
            )
    return names


def _is_condition(name: str) -> bool:
    from ebac.studies import conditions

    try:
        return bool(conditions([name]))
    except ValueError:
        return False


def condition_names(given: Sequence[str]) -> list[str]:
    """Return the conditions and groups of lists with commas."""
    from ebac.studies import conditions

    for text in given:
        joined = "".join(text.split())
        if " " in text.strip() and "," not in text and _is_condition(joined):
            raise ValueError(f"--condition {text}: a condition is one word: --condition {joined}")
    names = _words(given, "--condition")
    for name in names:
        try:
            conditions([name])
        except ValueError as error:
            raise ValueError(f"--{error}") from None
    doubtful.note_conditions(names)
    return names


def one_condition(name: str) -> str:
    """Return a condition by its name, where there can be one only; a group is refused by who searches."""
    names = condition_names([name])
    if len(names) != 1:
        raise ValueError(f"--condition {name}: one condition only; give one of {', '.join(names)}")
    return names[0]


def known_name(kind: str, option: str, name: str, names: Iterable[str]) -> str:
    """Return a name in lower case that is one of `names`; ValueError names the option and the nearest."""
    names = list(names)
    if name.lower() not in names:
        raise ValueError(unknown(f"{option} {name}", name.lower(), names, kind))
    return name.lower()
