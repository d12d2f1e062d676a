"""The table of `ebac gastroscopy master`, `slave` and `drives`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ebac.cli import output


def show(reports: dict[str, dict[str, Any]], faults: list[str], *, simulated: bool = True) -> None:
    """Print both sides of the chain, or one, and what was wrong."""
    sides = {name: one for name, one in reports.items() if name in ("master", "slave")}
    for name, row in sides.items():
        for event in row["events"] if len(sides) > 1 else []:
            output.say(f"{event['t_s']:8.2f} s  {name}: {event['text']}")
    grid = output.table(["", *sides], numbers=range(1, len(sides) + 1))
    for label, what in _ROWS:
        grid.add_row(label, *(what(row) for row in sides.values()))
    output.show(grid)
    if scope := sides.get("slave", {}).get("scope"):
        output.say(
            f"Gastroscope: {1e3 * scope['inserted_m']:.0f} mm behind the teeth, largest force of the wall "
            f"{scope['most_section_N']:.2f} N on the section, {scope['most_tube_N']:.2f} N on the tube."
        )
    for fault in faults:
        output.say(f"Fault: {fault}")
    if simulated:
        output.say("On simulated drives nothing was moved; no device was ever run with this.")


def _axes(row: dict[str, Any], key: str, units: Mapping[str, tuple[float, str]]) -> str:
    return ", ".join(
        f"{factor * row[key][name]:.2f} {unit}" for name, (factor, unit) in units.items()
    )


_LOADS = {
    "insertion_N": (1, "N"),
    "bend_x_N_m": (1, "N m"),
    "bend_y_N_m": (1, "N m"),
}
_PLACES = {"insertion_m": (1e3, "mm"), "bend_x_rad": (1, "rad"), "bend_y_rad": (1, "rad")}
_ROWS: tuple[tuple[str, Any], ...] = (
    ("ended by", lambda row: row["ended_by"]),
    ("links lost", lambda row: str(row["losses"])),
    ("round trip", lambda row: f"{1e3 * row['round_trip_s']:.0f} ms"),
    ("largest force asked of a drive", lambda row: f"{row['most_force_N']:.2f} N"),
    ("largest load: insertion, bends", lambda row: _axes(row, "most_load", _LOADS)),
    ("asked less slave, at the end", lambda row: _axes(row, "error", _PLACES)),
    ("asked less slave, largest", lambda row: _axes(row, "most_error", _PLACES)),
    (
        "energy into, out of the network",
        lambda row: f"{1e3 * row['energy_in_J']:.1f}, {1e3 * row['energy_out_J']:.1f} mJ",
    ),
    ("force while the link is lost", lambda row: f"{row['force_when_lost_N']:.2f} N"),
    ("latest tick", lambda row: f"{1e3 * row['latest_tick_s']:.1f} ms"),
    ("ticks skipped", lambda row: str(row["skipped_ticks"])),
    ("drives at the end", lambda row: ", ".join(row["drives"])),
)
