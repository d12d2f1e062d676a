"""What a contact and its force came to, in words."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from ebac._util.formatting import quantity, vibration_shown

if TYPE_CHECKING:
    from ebac.metrics import Contact

#: Energy with which the account of `ebac` begins [J]: a hand that draws more than that is named.
RESERVE = 0.01
#: A shorter run has no end at which to judge rest and swing [s].
JUDGED_FROM = 0.5


def verdict(contact: Contact) -> str:
    """Return what a contact came to: "exact and quiet", "swings", "quiet, too deep by 5.63 mm".

    One that is still and not quiet has a force that is not: "exact, force not quiet". One that rests where it should,
    but met less than half of the wall's stiffness where it was deepest: "exact and quiet, soft on impact".
    "not judged: the surface moves" where an engine reports that in the last 30 %. "moves with the hand" where the
    hand's target has not come to rest either, in contact or not at the end. "no contact" where the world never acted,
    "left the surface: no contact at rest" where it acts no more at rest, "too short to judge" for less than half a
    second. Where the hand drew more than `RESERVE`, that comes first: "draws 47.5 J: moves with the hand"; a verdict
    "swings" stands alone, as a swing that the hand does not make draws energy.
    """
    words, drawn = _met(contact), drawn_energy(contact)
    return words if words == "swings" or drawn <= RESERVE else f"draws {_in_joules(drawn)}: {words}"


def drawn_energy(contact: Contact) -> float:
    """Return the energy that the hand drew, as far as it is known [J]; that of a moving surface is not its own."""
    if contact.drawn_J is not None:
        return contact.drawn_J
    return 0.0 if contact.surface_moves else max(0.0, -(contact.least_energy_J or 0.0))


def _in_joules(energy: float) -> str:
    return f"{1e3 * energy:.3g} mJ" if energy < 1 else f"{energy:.3g} J"


def _met(contact: Contact) -> str:
    """Return what position and force came to."""
    if contact.touched is False:
        return "no contact"
    if contact.seconds is not None and contact.seconds < JUDGED_FROM:
        return "too short to judge"
    if contact.surface_moves:
        return "not judged: the surface moves"
    if contact.with_hand and not contact.still:
        return "moves with the hand"
    if contact.touched_at_rest is False:
        return "left the surface: no contact at rest"
    if not contact.still:
        return "swings"
    deviation = contact.deviation_m
    if deviation is None:
        return "quiet" if contact.quiet else "force not quiet"
    if contact.exact and contact.quiet:
        return "exact and quiet, soft on impact" if contact.soft else "exact and quiet"
    if contact.exact:
        return "exact, force not quiet"
    where = "too deep" if deviation > 0 else "not deep enough"
    away = f"{where} by {in_mm(abs(deviation))}"
    return f"quiet, {away}" if contact.quiet else f"{away}, force not quiet"


def in_mm(length: float) -> str:
    """Return a length [m] in millimetres, three digits of it, without an exponent where it is long."""
    shown = 1e3 * length
    return f"{shown:.0f} mm" if shown >= 999.5 else f"{shown:.3g} mm"


def force_verdict(
    quiet: bool, settled_s: float | None, jumps: float, perceived: float | None
) -> str:
    """Return what the force of a contact came to: "not quiet: settled 2.994 s, 338 jumps, vibration 19.8 thresholds".

    The vibration is in detection thresholds, as `Contact.perceived`.
    """
    settled = quantity(settled_s, "s", none="never")
    counted = "no jump" if jumps == 0 else f"{jumps:.0f} jump{'s' if jumps > 1 else ''}"
    vibration = "not known"
    if perceived is not None and isfinite(perceived):
        vibration = f"{vibration_shown(perceived):.3g} thresholds"
    return (
        f"{'quiet' if quiet else 'not quiet'}: settled {settled}, {counted}, vibration {vibration}"
    )
