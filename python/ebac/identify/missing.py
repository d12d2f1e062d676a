"""What is said where a log lacks a signal: what is left of its columns, and how to name one."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ebac.identify.columns import NAMES, listed, name_and_unit, quantity_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ebac.identify.recording import Recording

#: What a message calls a signal that every log must have, or most.
WORDS = {"t": "time", "x": "position", "force": "force of the hand"}


def not_found(signals: Sequence[str], headings: Sequence[str], left: Sequence[str]) -> str:
    """Return that signals were not found among the headings, and how to name the columns that are left.

    All that a log lacks is asked for at once; the force of the hand only beside another, since not all need it.
    """
    words = " and ".join(f"no {WORDS[signal]}" for signal in signals)
    ask = f"; {which_is_it(signals, left)}" if left else "; the file needs a column of it"
    return f"found {words} among {listed(list(headings))}{ask}"


def name_if_unread(signal: str, recordings: Sequence[Recording], before: str) -> str:
    """Return that a signal may be one of the columns that are not used, and how to name it; "" where all are used."""
    names = list(dict.fromkeys(name for r in recordings for name in r.unread))
    if not names:
        return ""
    return (
        f"{before} name its column as the signal {signal}, if it is one that is not used: {listed(names)} "
        f"({_example([signal], names)})"
    )


def which_is_it(signals: Sequence[str], left: Sequence[str]) -> str:
    """Return the question which of the headings that are left are these signals, the likeliest as examples."""
    which = "which is it" if len(signals) == 1 else "which are they"
    return f"{which}? For example {_example(signals, left)}"


def _example(signals: Sequence[str], left: Sequence[str]) -> str:
    """Return how to name columns as these signals, the likeliest of those that are left."""
    free, chosen = list(left), dict[str, str]()
    for signal in sorted(signals, key=lambda each: -max(_likelihood(each, h) for h in left)):
        if free:
            chosen[signal] = max(free, key=lambda h: _likelihood(signal, h))
            free.remove(chosen[signal])
    pairs = [f"{s!r}: {name_and_unit(s, chosen[s])[0]!r}" for s in signals if s in chosen]
    return f"columns={{{', '.join(pairs)}}}"


def _likelihood(signal: str, heading: str) -> int:
    """Return how likely a heading is that of a signal: by a word of its name, then by its unit."""
    words = re.split(r"[\W_]+", heading.partition(" [")[0].lower())
    try:
        fits = quantity_of("", signal, heading, name_and_unit(signal, heading)[1])[0] is not None
    except ValueError:  # another unit
        return 0
    return 1 + fits + 2 * any(word in NAMES[signal] for word in words)


def left_for(signal: str, r: Recording) -> str:
    """Return what follows after the name of a signal that a recording lacks: its channels, and what else was there."""
    found = f", only {', '.join(r.channels())}"
    if r.unread:
        return f"{found}; the file also has {listed(r.unread)}; {which_is_it([signal], r.unread)}"
    return f"{found}; name its column, columns={{{signal!r}: 'NAME'}}, or identify from a log that has one"


def force_of_hand(r: Recording) -> NDArray[np.float64]:
    """Return the force of the hand in a recording [N].

    Raises
    ------
    ValueError
        When it has none; the message names the columns that are left.
    """
    if r.force is None:
        raise ValueError(
            f"{r.name}: has no force of the hand, which eq. (4) needs{left_for('force', r)}"
        )
    return r.force
