"""The table of the gastroscopy tutorial: one physician, four runs."""

from __future__ import annotations

from printed import Printed, table

#: The runs of the page, and their options.
RUNS = {
    "first": "",
    "without feedback": "--feedback 0",
    "100 ms of delay": "--delay 0.1",
    "pedals": "--insertion pedals",
}


def runs(printed: Printed) -> str:
    """Return time and forces of each run, with what the physician feels."""
    rows = []
    for name, options in RUNS.items():
        (run,) = printed.rows(f"gastroscopy {options}".strip())
        rows.append(
            [
                name,
                f"{run['seconds_s']:.1f} s",
                f"{run['most_tip_N']:.2f} N",
                f"{run['most_section_N']:.2f} N",
                f"{run['over_limit_s']:.3f} s",
                f"{run['most_felt_N']:.2f} N",
            ]
        )
    forces = ["largest force, tip", "tip and bending section", "time above 6 N", "on the hand"]
    return table(["run", "time", *forces], rows)
