"""How the drives of a configuration are simulated: ids, dictionaries, zero and signs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ebac.hardware.dictionary import dictionary

if TYPE_CHECKING:
    from ebac.hardware.configuration import Configuration


def wiring_of(known: Configuration) -> dict[str, Any]:
    """Return the arguments of `ebac._core.DriveWiring`: plain values, as JSON holds them."""
    signs = known.simulated_signs or known.signs
    sheets = [dictionary(node) for node in known.drives.nodes]
    return {
        "nodes": [node.id for node in known.drives.nodes],
        "sheets": sheets if any(sheets) else [],
        "zero": list(known.counts_of_simulated_drives),
        "motor": list(signs.motor),
        "encoder": list(signs.encoder),
    }
