"""Draw the pictures of these pages anew, beside this file: `python docs/figures/make.py [name ...]`.

Each is what a command draws, which stands in the page above the picture; `energy` alone has no command.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import ebac
from ebac.plot import (
    Picture,
    colour,
    dress,
    legend,
    line,
    new_figure,
    plot_ablation,
    plot_map,
    plot_study,
    plot_walls,
    plot_zwidth,
)
from ebac.studies.maps import AXES, stability_map
from ebac.studies.zwidth import zwidth

HERE = Path(__file__).parent
LAWS = ("tca", "tca-damped", "eba", "ebac-printed", "ebac")
#: The reference scenario with the noise of a force sensor [N].
NOISY = ebac.Scenario(device=ebac.Device(sensor=ebac.ForceSensor(noise=0.03)))
#: Dots an inch and colours: legible on a page, and no file above 150 kB.
DPI, COLOURS = 80, 128


def walls() -> Picture:
    """`ebac wall --device-noise 0.03 --law tca --law eba --law ebac-printed --law ebac`."""
    names = ("tca", "eba", "ebac-printed", "ebac")
    return plot_walls([ebac.simulate(NOISY, name) for name in names])


def laws() -> Picture:
    """`ebac wall`, the picture of the README."""
    names = ("tca", "tca-damped", "eba", "ebac")
    return plot_walls([ebac.simulate(ebac.Scenario(), name) for name in names])


def hands() -> Picture:
    """`ebac study --device-noise 0.03` under five laws: where each of 60 hands ends."""
    return dict(plot_study(ebac.study(ebac.Operators.grid(), LAWS, base=NOISY)))["hands"]


def ablation() -> Picture:
    """`ebac ablation --device-noise 0.03`."""
    return plot_ablation(ebac.ablation(base=NOISY))


def map_kb() -> Picture:
    """`ebac map --side 100 --device-noise 0.03`: EBAC over wall stiffness and damping."""
    xs, ys = (AXES[name].values(100) for name in ("damping", "stiffness"))
    return plot_map(stability_map("ebac", xs=xs, ys=ys, base=NOISY))


def z_width() -> Picture:
    """`ebac zwidth --device-noise 0.03 --observer-every-law` under EBAC and the best of the simple laws."""
    for_the_area = {"stiffness": 5000.0, "virtual_damping": 64.0, "recovery_time": 0.73}
    laws: dict[str, Any] = {
        "direct": "direct",
        "tca-damped-tuned-observer": "tca-damped-tuned-observer",
        "lag-compensator-tuned-observer": "lag-compensator-tuned-observer",
        "lag-compensator, for the area": ebac.Variant("lag-compensator", for_the_area),
        "ebac": "ebac",
    }
    found = zwidth(laws, base=NOISY.replace(seconds=3.0, observer="every-law"))
    return plot_zwidth(found, ["usable", "energy", "quiet", "still"])


def energy() -> Picture:
    """The energy account under the drive that draws most, with the guard and without, on the encoder alone."""
    laws = {"ebac": "ebac", "guard off": ebac.Variant("ebac", {"guard": False})}
    found = ebac.study(ebac.Operators.grid(), laws, ["pumping"], base=NOISY.replace(observer=False))
    least = found.runs("guard off", "pumping")
    worst = int(least[np.argmin(found.columns["least_energy_J"][least])])
    figure = new_figure(10, 6)
    grid = figure.subplots(2, 1, sharex=True)
    traces = {
        name: found.trace(int(found.runs(name, "pumping")[worst % len(found.scenarios)]))
        for name in laws
    }
    for ax in grid:
        for name, trace in traces.items():
            shade = colour("ebac") if name == "ebac" else "#d55e00"
            line(ax, trace["t"], 1e3 * trace["true.energy"], color=shade, label=f"port, {name}")
        ax.axhline(-10, color="0.35", ls="--", lw=1, label="minus the reserve e(0), 10 mJ")
        dress(ax, "energy [mJ]")
    kept = traces["ebac"]
    line(
        grid[1], kept["t"], 1e3 * kept["law.energy"], color="black", lw=0.8, label="account of ebac"
    )
    grid[1].set_ylim(-15, 60)
    grid[1].set_xlabel("time [s]")
    for ax in grid:
        legend(ax)
    path = found.scenarios[worst % len(found.scenarios)].hand.path[0]
    assert isinstance(path, ebac.Sine)
    figure.suptitle(
        f"A drive of 20 kN/m swings by {1e3 * path.amplitude:g} mm at {path.frequency:g} Hz inside a wall of 10 kN/m, "
        "simulated; below, near zero",
        fontsize="medium",
    )
    return figure


FIGURES: dict[str, Callable[[], Picture]] = {
    "laws": laws,
    "walls": walls,
    "hands": hands,
    "ablation": ablation,
    "map": map_kb,
    "zwidth": z_width,
    "energy": energy,
}

if __name__ == "__main__":
    for name in sys.argv[1:] or FIGURES:
        file, drawn = HERE / f"{name}.png", BytesIO()
        FIGURES[name]().savefig(drawn, format="png", dpi=DPI)
        Image.open(drawn).convert("RGB").quantize(COLOURS).save(file, optimize=True)
        print(f"{file.name}: {file.stat().st_size / 1e3:.0f} kB")
