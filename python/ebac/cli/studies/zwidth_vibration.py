"""The table of `ebac zwidth` that shows how near a law is to the threshold of a quiet force."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.studies.zwidth import ZWidth


def show(found: ZWidth) -> None:
    """Print how near each law is to the threshold of a quiet force, and how far the noise moves it."""
    from ebac.studies.zwidth.result import SEEDS, STIFFNESSES

    rows = iter(found.vibrations())
    output.say("Vibration of the force, in detection thresholds; quiet is below 3.", style="bold")
    heads = [f"{stiffness / 1e3:g} kN/m" for stiffness in STIFFNESSES]
    grid = output.table(["delay", "law", *heads], numbers=range(2, 2 + len(heads)))
    cells_of = {(row["law"], row["delay_samples"], row["stiffness_N_per_m"]): row for row in rows}
    for number, delay in enumerate(found.delays):
        if number:
            grid.add_section()
        for law in found.laws:
            cells = (_range(cells_of[law, delay, stiffness]) for stiffness in STIFFNESSES)
            grid.add_row(str(delay), law, *cells)
    output.show(grid)
    first, damping = found.base.seed, next(iter(cells_of.values()))["damping_Ns_per_m"]
    output.say(
        f"Least and largest of the seeds {first} to {first + SEEDS - 1}, of a press or a tap, whichever vibrates more, "
        f"at a wall damping of {damping:g} N s/m. The areas above are those of seed {first}: --seed {first + 1} "
        "searches again with other noise."
    )


def _range(row: dict[str, Any]) -> str:
    """Return the least and the largest vibration over the seeds; one number where they are the same."""
    from ebac._util import formatting

    ends = [row["perceived_least"], row["perceived_largest"]]
    if None in ends:
        return "ended early"
    least, most = (f"{formatting.vibration_shown(end):.3g}" for end in ends)
    return least if least == most else f"{least} to {most}"
