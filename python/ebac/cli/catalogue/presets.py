"""`ebac presets`: the hands and devices known by name."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from ebac.cli import by_name, completion, output


def presets(
    name: Annotated[
        str | None,
        typer.Argument(
            help="Name of a hand or device: print its numbers as TOML, for a scenario file.",
            show_default=False,
            autocompletion=completion.presets,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """List the hands and devices that can be used by name, or show all numbers of one.

    **Examples**

    * `ebac presets`

    * `ebac presets joystick`: every number of it, as the start of a scenario file

    * `ebac wall --hand finger --device joystick`: use two of them
    """
    from ebac.presets import DEVICES, HANDS

    if name is not None:
        _show_one(name, as_json=as_json)
        return
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
            "weight_N": known.device.mechanics.handle_mass * known.device.mechanics.gravity,
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


def _show_one(name: str, *, as_json: bool) -> None:
    """Print the hand and the device of a name, as tables of a scenario file."""
    from ebac.presets import DEVICES, HANDS

    with output.refusing():
        name = by_name.known_name(
            "hand or device", "presets", name, dict.fromkeys([*HANDS, *DEVICES])
        )
    found: list[tuple[str, str, str]] = []
    if name in HANDS:
        hand = HANDS[name]
        source = _source(hand.source, indicative=hand.indicative)
        found.append(("hand", source, output.toml(hand=hand.hand)))
    if name in DEVICES:
        found.append(("device", DEVICES[name].source, output.toml(device=DEVICES[name].device)))
    if as_json:
        rows = [
            {"kind": kind, "name": name, "source": source, "toml": toml}
            for kind, source, toml in found
        ]
        typer.echo(output.document("presets", rows))
        return
    for kind, source, toml in found:
        typer.echo(f"# {kind} {name}: {source}\n# SI units: m, s, kg, N, A, rad\n{toml}")


def _source(source: str, *, indicative: bool) -> str:
    return f"{source} (indicative)" if indicative else source


def _show_hands(rows: list[dict[str, Any]]) -> None:
    grid = output.table(
        ["hand", "mass", "damping", "stiffness", "model", "source"], numbers=(1, 2, 3)
    )
    for row in rows:
        grid.add_row(
            row["name"],
            f"{row['mass_kg']:g} kg",
            f"{row['damping_Ns_per_m']:g} N s/m",
            f"{row['stiffness_N_per_m']:g} N/m",
            row["model"] or "-",
            _source(row["source"], indicative=row["indicative"]),
        )
    output.show(grid)
    output.say("indicative: from memory of the literature, not confirmed.")


def _show_devices(rows: list[dict[str, Any]]) -> None:
    grid = output.table(
        ["device", "axes", "mass", "damping", "weight", "source"], numbers=(1, 2, 3, 4)
    )
    for row in rows:
        grid.add_row(
            row["name"],
            str(row["axes"]),
            f"{row['mass_kg']:.4g} kg",
            f"{row['damping_Ns_per_m']:g} N s/m",
            f"{row['weight_N']:.4g} N",
            row["source"],
        )
    output.show(grid)
