"""Messages of the page of `ebac live`: read strictly, so that nothing else reaches the loop."""

from __future__ import annotations

import json
from typing import Any

from ebac._util.wrong_calls import plain_constructor

#: Longest message [bytes].
LONGEST = 2048
#: Kinds of messages, and what each carries beside its kind: name and types.
KINDS: dict[str, dict[str, tuple[type, ...]]] = {
    "hold": {},
    "release": {},
    "drag": {"place": (list,)},
    "drop": {},
    "mode": {"mode": (str,)},
    "change": {"name": (str,), "value": (str, int, float, bool)},
    "start": {},
    "pause": {},
    "reset": {},
    "record": {"on": (bool,)},
    "save": {},
    "take": {},
}


@plain_constructor
class MalformedError(ValueError):
    """What no page of this version sends."""


def read(raw: str | bytes) -> dict[str, Any]:
    """Return a message, checked.

    Raises
    ------
    MalformedError
        For anything but a known kind with what belongs to it.
    """
    if not isinstance(raw, str) or len(raw) > LONGEST:
        raise MalformedError("must be text of 2048 characters at most")
    try:
        found = json.loads(raw, parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        raise MalformedError("is no JSON") from error
    if not isinstance(found, dict) or not isinstance(kind := found.get("kind"), str):
        raise MalformedError("has no kind")
    if kind not in KINDS:
        raise MalformedError(f"unknown kind {kind[:20]!r}")
    wanted = KINDS[kind]
    if set(found) != {"kind", *wanted}:
        raise MalformedError(f"{kind} carries {', '.join(wanted) or 'nothing'}")
    for name, types in wanted.items():
        value = found[name]
        if not isinstance(value, types) or (isinstance(value, bool) and bool not in types):
            raise MalformedError(f"{kind}.{name} is of a wrong type")
        if isinstance(value, list) and not all(
            isinstance(one, (int, float)) and not isinstance(one, bool) for one in value
        ):
            raise MalformedError(f"{kind}.{name} must be numbers")
    return found


def _refuse(word: str) -> None:
    raise ValueError(word)
