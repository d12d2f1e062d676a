"""The sign of the force of the hand: by what a target that moves shows, and by a fit to the force of the other sign."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import TYPE_CHECKING

from ebac.identify.informativeness import check_log
from ebac.identify.parameters import HAND, kind
from ebac.identify.plausible import is_hand
from ebac.identify.recording import Recording
from ebac.identify.target import Target
from ebac.identify.validation import POOR, SURE

if TYPE_CHECKING:
    from ebac.identify.result import ArmResult

#: Spectra that are less precise may be those of a hand whose target is not what was said.
PRECISE = 0.05


def likely_flip(
    recordings: Sequence[Recording],
    targets: Sequence[Target],
    result: ArmResult,
    other: ArmResult,
) -> str:
    """Return what says that the force has the other sign: "fit", "spectra", or "" for nothing.

    How much of the motion a fit explains does not decide it: with the wrong sign it models device and wall, and that
    explains all of it. Where a target moves, motion and force follow it, and these show the sign, unless the fit to the
    force of the other sign explains too little: then the target is not the right one. Where none moves, that fit must
    be one of a hand.
    """
    sound = _is_sound(other)
    if any(target.switches or target.path is not None for target in targets):
        pairs = zip(recordings, targets, strict=True)
        known = min((_other_sign(r, target) for r, target in pairs), default=inf)
        if sound and known < inf:
            return "fit"
        return "spectra" if known < PRECISE and other.explained > SURE else ""
    return "fit" if sound and other.explained > max(POOR, result.explained) else ""


def _is_sound(result: ArmResult) -> bool:
    """Return whether a fit is that of a hand, all of it determined."""
    lost = {kind(name) for name in result.undetermined}
    return not lost.intersection(HAND) and is_hand(result.parameters, result.values)


def _other_sign(recording: Recording, target: Target) -> float:
    """Return how precisely the spectra show a hand with the force of the other sign only; infinite where they do not.

    As the largest expected deviation, relative to its value.
    """
    try:
        if check_log(recording, target).other_sign:
            return max(check_log(recording.flipped(), target).deviation.values())
    except ValueError:  # too short for spectra
        pass
    return inf
