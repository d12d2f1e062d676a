"""`ebac presets`: the hands and devices known by name."""

from __future__ import annotations

from typing import Any

import typer

from ebac.cli import output


def presets(as_json: output.AsJson = False) -> None:
    """List the hands and devices that can be used by name.

    **Examples**

    * `ebac presets`

    * `ebac wall --hand finger --device joystick`: use two of them
    """
    from ebac.presets import DEVICES, HANDS

    hands = [
        {
            "kind": "hand",
            "name": name,
            "mass_kg": known.hand.mass,
            "damping_Ns_per_m": known.hand.damping,
            "stiffness_N_per_m": known.hand.stiffness,
            "model": None if known.hand.model is None else type(known.hand.model).__name__,
            "source": known.source,
            "indicative": known.indicative,
        }
        for name, known in HANDS.items()
    ]
    devices = [
        {
            "kind": "device",
            "name": name,
            "mass_kg": known.device.mass,
            "damping_Ns_per_m": known.device.mechanics.damping,
            "axes": known.device.axes,
            "source": known.source,
        }
        for name, known in DEVICES.items()
    ]
    if as_json:
        typer.echo(output.document("presets", [*hands, *devices]))
        return
    _show_hands(hands)
    _show_devices(devices)


def _show_hands(rows: list[dict[str, Any]]) -> None:
    grid = output.table(
        ["hand", "mass", "damping", "stiffness", "model", "source"], numbers=(1, 2, 3)
    )
    for row in rows:
        source = f"{row['source']} (indicative)" if row["indicative"] else row["source"]
        grid.add_row(
            row["name"],
            f"{row['mass_kg']:g} kg",
            f"{row['damping_Ns_per_m']:g} N s/m",
            f"{row['stiffness_N_per_m']:g} N/m",
            row["model"] or "-",
            source,
        )
    output.show(grid)
    output.say("indicative: from memory of the literature, not confirmed.")


def _show_devices(rows: list[dict[str, Any]]) -> None:
    grid = output.table(["device", "axes", "mass", "damping", "source"], numbers=(1, 2, 3))
    for row in rows:
        grid.add_row(
            row["name"],
            str(row["axes"]),
            f"{row['mass_kg']:.4g} kg",
            f"{row['damping_Ns_per_m']:g} N s/m",
            row["source"],
        )
    output.show(grid)
