"""How the drives of a configuration are simulated: ids, dictionaries, zero and signs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ebac.hardware.dictionary import dictionary

if TYPE_CHECKING:
    from ebac.hardware.configuration import Configuration


def wiring_of(known: Configuration) -> dict[str, Any]:
    """Return the arguments of `ebac._core.DriveWiring` but for the signs: plain values, as JSON holds them.

    The loop of a simulated run leaves its own signs out instead (`Backend.signs`).
    """
    sheets = [dictionary(node) for node in known.drives.nodes]
    return {
        "nodes": [node.id for node in known.drives.nodes],
        "sheets": sheets if any(sheets) else [],
        "zero": list(known.counts_of_simulated_drives),
    }


def wired_with_signs(known: Configuration) -> dict[str, Any]:
    """Return the same with the signs that the simulated device needs, for a loop that connects over a bus."""
    signs = known.simulated_signs or known.signs
    return {**wiring_of(known), "motor": list(signs.motor), "encoder": list(signs.encoder)}
