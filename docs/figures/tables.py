"""Write the tables of these pages anew from what the commands print: `python docs/figures/tables.py [name ...]`.

    python docs/figures/tables.py                      # all but those of `ASKED`: about an hour on two cores
    python docs/figures/tables.py grid --kept DIR      # one; what DIR holds of an earlier call is not run again
    python docs/figures/tables.py speed                # only by its name: where nothing else runs
    python docs/figures/tables.py limits-worst         # only by its name, as all of `limits-`, `held-` and `friction-`

A table stands between `<!-- table: NAME -->` and `<!-- end -->`; what a page says around it stays as it is.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from pathlib import Path

import adversaries as hostile
import device_tables as devices
import fact_tables as facts
import failure_tables as failing
import friction_tables as friction
import gastroscopy_tables as gastroscopy
import held_tables as holding
import identify_tables as identified
import key_tables as file_keys
import law_tables as laws
import limit_tables as limits
import population_tables as populations
import rival_tables as rivals
import sensor_limit_tables as sensors
import story_tables as story
import swing_tables as swinging
import tracking_tables as tracked
import world_tables as worlds
from printed import Printed, names, put

DOCS = Path(__file__).parents[1]
PAGES = tuple(page for page in sorted(DOCS.rglob("*.md")) if names(page))
TABLES: dict[str, Callable[[Printed], str]] = {
    "grid": populations.grid,
    "tuned": rivals.tuned,
    "tuned-cells": rivals.tuned_cells,
    "tuned-impact": rivals.tuned_impact,
    "tuned-sways": rivals.tuned_sways,
    "tuned-values": rivals.tuned_values,
    "hands": story.hands,
    "cells": populations.cells,
    "five": populations.five,
    "robustness-good": populations.robustness_good,
    "robustness-energy": populations.robustness_energy,
    "models": populations.models,
    "failures": failing.failures,
    "held": populations.held,
    "damped": populations.damped,
    "ablation": laws.ablation,
    "ablation-encoder": laws.ablation_encoder,
    "pieces": story.pieces,
    "worst": laws.worst,
    "zwidth": rivals.z_width,
    "zwidth-explored": rivals.z_width_explored,
    "zwidth-devices": devices.encoder_and_friction,
    "adversaries": hostile.adversaries,
    "walls": story.walls,
    "identify-arm": identified.arm,
    "identify-device": identified.device,
    "identify-scale": identified.scale,
    "identify-gains": identified.gains,
    "identify-gains-seeds": identified.gains_by_seed,
    "friction-declared": friction.declared,
    "friction-kept": friction.kept_walls,
    "held-energy": holding.energy,
    "held-limited": holding.limited,
    "swing-energy": swinging.energy,
    "swing-scale": swinging.scaled,
    "swing-times": swinging.timed,
    "limits-worst": limits.worst_hands,
    "limits-milliseconds": limits.milliseconds,
    "limits-counts": limits.counts,
    "limits-rate": limits.rate,
    "limits-noise": sensors.noise,
    "limits-bias": sensors.bias,
    "limits-bias-learned": sensors.learned_bias,
    "limits-scale": sensors.scale,
    "limits-steps": sensors.steps,
    "limits-motor": sensors.motor,
    "limits-facts": facts.told,
    "outliers": tracked.outliers,
    "gastroscopy": gastroscopy.runs,
    "engines": worlds.engines,
    "shapes-soft": worlds.soft_shapes,
    "shapes-stiff": worlds.stiff_shapes,
    "speed": laws.speed,
    **file_keys.TABLES,
}
#: Left out unless asked for: what `speed` says depends on what else the machine does; the others take long.
ASKED = {
    "speed",
    *(name for name in TABLES if name.startswith(("friction-", "held-", "limits-", "swing-"))),
}


def main() -> None:
    """Write the tables that are asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("names", nargs="*", metavar="name", help=f"one of {', '.join(TABLES)}")
    parser.add_argument(
        "--kept", type=Path, help="folder of the JSON documents; default: none are kept"
    )
    parser.add_argument("--threads", type=int, help="default: one per core")
    given = parser.parse_args()
    if unknown := set(given.names) - set(TABLES):
        parser.error(f"no such table: {', '.join(sorted(unknown))}; there are: {', '.join(TABLES)}")
    with tempfile.TemporaryDirectory() as passing:
        folder = given.kept or Path(passing)
        folder.mkdir(parents=True, exist_ok=True)
        printed = Printed(folder=folder, threads=given.threads)
        for name in given.names or [name for name in TABLES if name not in ASKED]:
            text = TABLES[name](printed)
            for page in (page for page in PAGES if name in names(page)):
                print(f"{name}, {page.name}: {'changed' if put(page, name, text) else 'as before'}")


if __name__ == "__main__":
    main()
