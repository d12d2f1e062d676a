"""Wrong input in one sentence: the option, its value, what it must be, and the nearest right word."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from difflib import get_close_matches
from math import isfinite
from typing import Any

from ebac._util.arguments import of_percent, unknown
from ebac._util.headings import FACTORS

#: Options of a scenario, and the options that set the same where a command varies it.
VARIED = {
    r"--hand(-\w+)?": ("--population", "--family"),
    r"--wall-\w+": ("--condition", "--most-stiffness"),
    r"--delay": ("--condition",),
}

#: Facts of a device that no option gives, and their keys in a file.
IN_FILES = {
    "--device-mass": "handle_mass in [device.mechanics]",
    "--device-damping": "damping in [device.mechanics]",
    "--device-inertia": "rotor_inertia in [device.motor]",
    "--device-radius": "radius in [device.kinematics]",
    "--device-count": "counts_per_turn in [device.encoder]",
    "--device-motor": "[device.motor]",
    "--device-encoder": "[device.encoder]",
}

#: Options that a command with a configuration lacks, and the keys of that which set the same.
IN_CONFIGURATION = {
    "--observer-learns": "learn_scale = true in [observer]",
    "--observer-every-law": "every_law = true in [observer]",
}

#: Options by words that people use for them, which look like others.
MEANT = {"--device-friction": ("--device-coulomb", "--device-friction-compensation")}

#: Options that only some commands have, and these.
OF_OTHERS = {"--change": ("ablation", "stiffest", "study", "wall", "worst", "zwidth")}

#: Options that a command lacks because it does that anyway.
ANYWAY = {
    "run --log": "a run always writes its log, run-TIME.mcap in the folder of --out (ebac-run; with --json only where "
    "--out is given), and --no-files writes none",
}

#: Thousandths of a unit, in which people have many numbers.
SMALL = {"s": "ms", "m": "mm", "kg": "g"}

#: What people look for who give an argument to a command that takes none.
INSTEAD = {
    "bus load": "`ebac drive plan FILE` prints the load of a network file or profile",
    "drive show": "`ebac drive show --node 1` reads a drive on the bus, `ebac drive profile NAME` prints a file",
    "conditions": "`ebac study --condition NAME` runs a condition",
}


def sentence(error: Any, command: Any, words: Sequence[str]) -> str:
    """Return what is wrong, from an error of the parser and the words it was given."""
    wrong = getattr(error, "option_name", None)
    message = str(error.message or error.format_message()).strip().rstrip(".")
    if message.startswith("No such option"):
        return _unknown_option(str(wrong), command)
    param = getattr(error, "param", None)
    if param is None:
        return _plain(message, wrong, error, command)
    name = option_name(param)
    if type(error).__name__ == "MissingParameter":
        return f"{name}: is missing; {_help(param)}"
    return f"{_wrong_value(param, name, message, words)}"


def not_finite(command: Any, values: dict[str, Any]) -> str:
    """Return a sentence for the first number of the options that is NaN or infinite; "" for none."""
    for param in command.params:
        value = values.get(param.name)
        for one in value if isinstance(value, (list, tuple)) else [value]:
            if isinstance(one, float) and not isfinite(one):
                return f"{option_name(param)} = {one}{_unit(param)}: must be a finite number"
    return ""


def option_name(param: Any) -> str:
    """Return how a person writes a parameter: its long option, or its placeholder."""
    long = [name for name in param.opts if name.startswith("--")]
    if long:
        return str(long[0])
    return str(getattr(param, "metavar", None) or param.name.upper()).strip("[].")


def is_number(param: Any) -> bool:
    """Return whether a parameter takes numbers."""
    return bool(re.search("int|float", _kind(param)))


def _wrong_value(param: Any, name: str, message: str, words: Sequence[str]) -> str:
    given = list(values_of(param, words))
    low, high = _range(param)
    unit = _unit(param)
    if (low, high) != (None, None) or re.search(r"number|integer|float", message):
        whole = bool(re.search(r"integer", message)) or _whole(param)
        kind = "a whole number" if whole else "a number"
        text = next((v for v in given if _is_text(v, whole=whole)), None)
        if text is not None:
            within = f"; {_must(low, high, unit)}" if (low, high) != (None, None) else ""
            remedy = _converted(text, unit) or _of_percent(text.rstrip("% "), high, unit)
            return f"{name} = {text}: must be {kind}{_in(unit)}{within}{remedy}"
        value = next((v for v in given if not _inside(v, low, high)), given[0] if given else "")
        return f"{name} = {value}{unit}: {_must(low, high, unit)}{_remedy(value, low, high, unit)}"
    choices = _choices(param)
    if choices:
        value = given[0] if given else ""
        return unknown(f"{name} {value}", value, choices)
    value = f" {given[0]}" if given else ""
    return f"{name}{value}: {message[0].lower()}{message[1:]}"


def _converted(text: str, unit: str) -> str:
    """Return the number that a value with a unit is in the unit of its option; "" where that is not known."""
    found = re.fullmatch(r"([-+]?\d+\.?\d*(?:e[-+]?\d+)?) *(\D.*)", text)
    wanted = unit.strip()
    if found and wanted == "samples" and found[2] in FACTORS["time"]:
        return "; a sample is 1 ms at 1 kHz"
    for units in FACTORS.values():
        if not found or wanted not in units:
            continue
        if found[2] in units:
            return f"; give {float(found[1]) * units[found[2]] / units[wanted]:.10g}"
        meant = next((one for one in units if one.split("/")[0] == found[2]), None)
        if meant is not None:
            number = float(found[1]) * units[meant] / units[wanted]
            return f"; for {found[1]} {meant} give {number:.10g}"
    return ""


def _of_percent(text: str, high: float | None, unit: str) -> str:
    """Return the share that a value in per cent is, where an option takes a share."""
    is_share = high == 1 and not unit and not _is_text(text, whole=False)
    return of_percent(float(text)) if is_share else ""


def _remedy(value: str, low: float | None, high: float | None, unit: str) -> str:
    """Return what a number may have been meant as: a share in per cent, or thousandths as the library sees them."""
    small = SMALL.get(unit.strip())
    if small is None or high is None or _is_text(value, whole=False):
        return _of_percent(value, high, unit)
    meant = float(value) / 1000
    if not (float(value) > 1.1 * high and (low or 0.0) <= meant <= high):
        return ""
    return f"; {float(value):g} {small} is {meant:g}{unit}"


def values_of(param: Any, words: Sequence[str]) -> Iterator[str]:
    """Give the words that were given to an option; for an argument, every word that is no option."""
    names = {*param.opts, *param.secondary_opts}
    if not any(name.startswith("-") for name in names):
        yield from (word for word in words if not word.startswith("--"))
        return
    several = max(1, param.nargs)
    for i, word in enumerate(words):
        name, equals, value = word.partition("=")
        if word in names:
            yield from words[i + 1 : i + 1 + several]
        elif equals and name in names:
            yield value


def _unknown_option(wrong: str, command: Any) -> str:
    shown = [p for p in command.params if not getattr(p, "hidden", False)]
    known = [name for p in shown for name in (*p.opts, *p.secondary_opts)]
    known = [name for name in known if name.startswith("--")]
    for pattern, others in VARIED.items():
        other = next((name for name in others if name in known), None)
        if other is not None and re.fullmatch(pattern, wrong):
            return f"{wrong}: there is no such option here, {other} sets it; see --help"
    if wrong in IN_FILES and "--scenario" in known:
        return (
            f"{wrong}: there is no such option here, {IN_FILES[wrong]} of the file of --scenario sets it; "
            "`ebac presets reference > FILE` writes one"
        )
    if wrong in IN_CONFIGURATION and any(p.name == "configuration" for p in shown):
        key = IN_CONFIGURATION[wrong]
        return f"{wrong}: there is no such option here, {key} of the configuration sets it"
    if anyway := ANYWAY.get(f"{command.name} {wrong}"):
        return f"{wrong}: there is no such option here; {anyway}"
    if wrong in OF_OTHERS:
        have = _or([f"`ebac {name}`" for name in OF_OTHERS[wrong]], "and")
        return f"{wrong}: there is no such option here; {have} have it"
    bare = {name[2:]: name for name in known}  # two dashes are no likeness
    tails = {name.partition("-")[2]: name for name in bare if "-" in name}
    word = wrong.lstrip("-")
    close = (
        [name[2:] for name in MEANT.get(wrong, ()) if name in known]
        or [name for name in bare if name.partition("-")[2] == word]
        or get_close_matches(word, bare, 2)
        or [tails[tail] for tail in get_close_matches(word, tails, 2)]
    )
    hint = f", did you mean {_or([bare[name] for name in close])}" if close else ""
    return f"{wrong}: there is no such option{hint}; see --help"


def _plain(message: str, wrong: str | None, error: Any, command: Any) -> str:
    if wrong and "requires" in message:
        many = next((param.nargs for param in command.params if wrong in param.opts), 1)
        return f"{wrong}: needs {f'{many} values' if many > 1 else 'a value'} after it"
    found = re.search(r"unexpected extra argument(?:s|\(s\))? \((.*)\)", message)
    if found:
        return f"{found[1]}: {_too_many(error.ctx, found[1])}"
    return f"{message[0].lower()}{message[1:]}"


def _too_many(context: Any, words: str) -> str:
    name = context.command_path.removeprefix("python -m ").partition(" ")[2]
    remedy = INSTEAD.get(name, "quote a value that has spaces")
    if words.endswith(".toml") and any("--scenario" in p.opts for p in context.command.params):
        remedy = f"a file is given as --scenario {words}"
    elif _are_laws(words.split()) and any("--law" in p.opts for p in context.command.params):
        remedy = "several laws are given as --law tca,ebac"
    remedy += ", or see --help"
    if any(param.param_type_name == "argument" for param in context.command.params):
        return f"too many words; {remedy}"
    return f"`ebac {name}` takes no argument, only options; {remedy}"


def _are_laws(words: Sequence[str]) -> bool:
    from ebac.laws import LAWS

    return all(word in LAWS for word in words)


def _or(words: Sequence[str], joint: str = "or") -> str:
    return f" {joint} ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def _help(param: Any) -> str:
    text = " ".join(str(getattr(param, "help", None) or "see --help").split())
    text = text.replace("`", "").rstrip(".")
    return f"{text[0].lower()}{text[1:]}" if text[1:2].islower() else text


def _unit(param: Any) -> str:
    """Return the unit that the help of an option names in square brackets, after a space."""
    found = re.search(r"\[([^\]]+)\]", str(getattr(param, "help", None) or ""))
    return f" {found[1]}" if found else ""


def _in(unit: str) -> str:
    return f" (in{unit})" if unit else ""


def _range(param: Any) -> tuple[float | None, float | None]:
    kind = getattr(param, "type", None)
    low, high = (getattr(param, name, getattr(kind, name, None)) for name in ("min", "max"))
    return low, high


def _choices(param: Any) -> list[str]:
    kind = getattr(param, "type_descriptor", None) or getattr(param, "type", None)
    return [str(getattr(one, "value", one)) for one in getattr(kind, "choices", None) or ()]


def _whole(param: Any) -> bool:
    return "int" in _kind(param)


def _kind(param: Any) -> str:
    """Return what names the type of a parameter, in any release of typer."""
    kind = getattr(getattr(param, "type", None), "name", "")
    annotation = getattr(getattr(param, "type_descriptor", None), "annotation", "")
    return f"{kind} {annotation}"


def _must(low: float | None, high: float | None, unit: str) -> str:
    """Return a range in the words of the library."""
    if high is None:
        return f"must be at least {low:g}{unit}"
    return (
        f"must be at most {high:g}{unit}"
        if low is None
        else f"must lie in [{low:g}, {high:g}]{unit}"
    )


def _is_text(text: str, *, whole: bool) -> bool:
    try:
        int(text) if whole else float(text)
    except ValueError:
        return True
    return False


def _inside(text: str, low: float | None, high: float | None) -> bool:
    value = float(text)
    return (low is None or value >= low) and (high is None or value <= high)
