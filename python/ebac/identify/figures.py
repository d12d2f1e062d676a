"""Figures of a fit of an arm, a device or the gains, and the report page that holds them."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from ebac.plot.style import dress, legend, line, new_figure, plain_decades

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ebac.identify.device_result import DeviceResult
    from ebac.identify.gains.gains import GainsResult
    from ebac.identify.gains.trial import Candidate
    from ebac.identify.result import ArmResult
    from ebac.plot.style import Picture


def plot_arm(result: ArmResult, recording: int = 0) -> Picture:
    """Draw motion and model, force, errors, their correlations and the frequency response, of one recording."""
    figure = new_figure(10, 13)
    motion, force, left, auto, size, follows = figure.subplots(
        6, 1, height_ratios=[2, 1.2, 1.2, 1.2, 1.6, 0.8]
    )
    r = result.recordings[recording]
    assert r.force is not None
    model = result.simulated(recording)
    line(motion, r.t, 1e3 * r.x, color="0.35", lw=1.6, label=r.origin)
    line(
        motion,
        r.t,
        1e3 * model,
        color="#009e73",
        lw=1.0,
        ls="--",
        label="hand, from the force alone",
    )
    dress(motion, "position [mm]")
    legend(motion)
    line(force, r.t, r.force, color="#0072b2", lw=0.8)
    dress(force, "force [N]")
    line(left, r.t, 1e3 * (r.x - model), color="#d55e00", lw=0.8)
    dress(left, "log less\nhand [mm]")
    left.set_xlabel("time [s]")
    _correlations(auto, result, r.name)
    _response(size, follows, result, recording)
    figure.suptitle(
        f"arm identified from {r.name} ({r.origin})\n"
        + ", ".join(str(e) for e in list(result.estimates.values())[:3]),
        fontsize="medium",
    )
    return figure


def _response(size: Axes, follows: Axes, result: ArmResult, recording: int) -> None:
    """Draw |Z(f)| of the log and as fitted, and the coherence; a log too short for it stays without."""
    from ebac.identify.response import frequency_response

    r, target = result.recordings[recording], result.problem.targets[recording]
    theta = result.values[result.parameters.places[recording]]
    mass, damping, stiffness = theta[:3].tolist()
    levels = theta[result.parameters.before_levels :]
    try:
        z = frequency_response(r, target, levels, stiffness)
    except ValueError as error:
        for ax in (size, follows):
            ax.text(0.5, 0.5, str(error), ha="center", transform=ax.transAxes, fontsize="small")
        return
    f = z.frequency
    sure = z.coherence >= z.significant
    for which, shade, word in (
        (sure, "0.3", "of the log (H1), one standard deviation"),
        (~sure, "0.8", "where the coherence may be chance"),
    ):
        if which.any():
            size.errorbar(
                f[which],
                np.abs(z.stiffness[which]),
                yerr=z.deviation()[which],
                fmt=".",
                color=shade,
                ecolor="0.8",
                label=word,
            )
    if z.by_target is not None:
        size.plot(
            f,
            np.abs(z.by_target),
            "+",
            color="#0072b2",
            ms=5,
            label="of the log, the target as instrument",
        )
    size.plot(
        f, np.abs(z.model(mass, damping, stiffness)), color="#009e73", label="eq. (4) as fitted"
    )
    size.set(xscale="log", yscale="log")
    plain_decades(size.xaxis)
    model = np.abs(z.model(mass, damping, stiffness))
    size.set_ylim(0.2 * model.min(), 5 * model.max())
    dress(size, "|Z| = |K0 + B0 s + M0 s²|\n[N/m]")
    legend(size)
    follows.plot(f, z.coherence, color="0.3", lw=1)
    follows.axhline(
        z.significant,
        color="#d55e00",
        lw=0.8,
        ls="--",
        label="above by chance in 5 % of the frequencies",
    )
    follows.set(xscale="log", ylim=(0, 1.05))
    plain_decades(follows.xaxis)
    follows.set_xlabel("frequency [Hz]")
    dress(follows, "coherence")
    legend(follows)


def plot_device(result: DeviceResult) -> Picture:
    """Draw motion, force and model, and friction over speed: what is left when inertia and weight are taken off."""
    from ebac.identify.device_problem import columns_of

    figure = new_figure(10, 9)
    motion, force, friction = figure.subplots(3, 1, height_ratios=[1, 1.2, 1.6])
    r, drive = result.recording, result.drive
    by, way, effort = (1.0, "rad", "torque") if r.rotary else (1e3, "mm", "force")
    strength = r.units[1]
    for rows in r.stretches:  # nothing was recorded in a pause
        line(motion, r.t[rows], by * r.x[rows], color="0.35", lw=1.2)
    dress(motion, f"{'angle' if r.rotary else 'position'} [{way}]")
    on = drive.slides
    columns = columns_of(drive, result.stribeck_speed)
    model = np.full(len(r.t), np.nan)
    model[on] = columns @ result.values
    for i, rows in enumerate(r.stretches):
        label = "_" if i else f"{r.origin}, smoothed"
        line(force, r.t[rows], -drive.smooth_force[rows], color="0.35", lw=1.4, label=label)
    force.plot(
        r.t, model, color="#009e73", lw=1.0, ls="--", label="eq. (6) with friction, where it slides"
    )
    dress(force, f"driving {effort} [{strength}]")
    force.set_xlabel("time [s]")
    legend(force)
    left = -drive.smooth_force[on] - columns[:, [0, 3]] @ result.values[[0, 3]]
    v = drive.velocity[on]
    rest = f"{effort} less inertia and weight"
    friction.plot(by * v, left, ".", ms=1.5, color="0.7", label=rest)
    for side in (v > 0, v < 0):
        order = np.argsort(v[side])
        parts = np.delete(columns, [0, 3], axis=1)[side] @ np.delete(result.values, [0, 3])
        friction.plot(by * v[side][order], parts[order], color="#d55e00", lw=1.6)
    friction.plot([], [], color="#d55e00", label="damping and friction as fitted")
    dress(friction, f"friction [{strength}]")
    friction.set_xlabel(f"velocity [{way}/s]")
    legend(friction)
    words = ", ".join(str(e) for e in list(result.estimates.values())[:3])
    figure.suptitle(f"device identified from {r.name} ({r.origin})\n{words}", fontsize="medium")
    return figure


def _correlations(ax: Axes, result: ArmResult, name: str) -> None:
    tests = result.tests.get(name)
    if tests is None:
        ax.text(
            0.5, 0.5, "too few readings to test the errors", ha="center", transform=ax.transAxes
        )
        return
    ax.axhspan(-tests.band, tests.band, color="0.9", label="95 % of white noise")
    ax.plot(
        np.arange(1, len(tests.auto) + 1),
        tests.auto,
        color="#0072b2",
        label="of the difference with itself",
    )
    ax.plot(np.arange(len(tests.cross)), tests.cross, color="#d55e00", label="with the force")
    ax.set_xlabel("lag [readings]")
    dress(ax, "correlation")
    legend(ax)


COLOURS = {"default": "#d55e00", "step-response": "#0072b2", "chosen": "#009e73"}


def plot_gains(result: GainsResult) -> Picture:
    """Draw the press of the identified hand under default, rule and choice, and what was tried."""
    from ebac.laws import Variant
    from ebac.simulation import simulate

    figure = new_figure(10, 9)
    motion, force, tried = figure.subplots(3, 1, height_ratios=[1.2, 1.2, 1.4])
    scenario = result.scenario.replace(seconds=1.5)
    for c in (result.default, *result.rules, result.chosen):
        trace = simulate(scenario, Variant(result.name, {"kp": c.kp, "kd": c.kd}))
        style = {"color": COLOURS[c.name], "lw": 1.0, "label": _label(c)}
        surface = scenario.environment.position  # type: ignore[union-attr]
        line(motion, trace["t"], 1e3 * (trace.axis("true.x") - surface), **style)
        line(force, trace["t"], trace.axis("f_applied"), **style)
    motion.axhline(0, color="0.6", lw=0.8)
    dress(motion, "depth in the wall [mm]")
    motion.set_ylim(bottom=-4)
    legend(motion, columns=3)
    dress(force, "force [N]")
    force.set_xlabel("time [s]")
    _map(tried, result)
    figure.suptitle(
        f"{result.name}: gains of eq. (2), simulated on the loop of the log", fontsize="medium"
    )
    return figure


def _label(c: Candidate) -> str:
    return f"{c.name}: Kp {c.kp:.3g}, Kd {1e3 * c.kd:.3f} ms"


def _map(ax: Axes, result: GainsResult) -> None:
    kept = [c for c in result.tried if not c.broken]
    lost = [c for c in result.tried if c.broken]
    ax.plot(
        [c.kp for c in lost],
        [1e3 * c.kd for c in lost],
        "x",
        color="0.6",
        label="breaks a constraint",
    )
    cost = np.log10([c.cost for c in kept])
    dots = ax.scatter(
        [c.kp for c in kept],
        [1e3 * c.kd for c in kept],
        c=cost,
        cmap="viridis_r",
        s=28,
        label="keeps all",
    )
    bar = ax.figure.colorbar(dots, ax=ax)
    bar.set_label("log10 of the cost, 0: default")
    chosen = result.chosen
    ax.plot(
        chosen.kp,
        1e3 * chosen.kd,
        "o",
        mfc="none",
        ms=14,
        mew=2,
        color=COLOURS["chosen"],
        label="chosen",
    )
    ax.set_xlabel("Kp [1]")
    dress(ax, "Kd [ms]")
    ax.margins(0.05)
    legend(ax, columns=3)


_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; color: #222 }
.wide { overflow-x: auto } table { border-collapse: collapse; margin: 1rem 0 } td { white-space: nowrap }
th, td { padding: .25rem .8rem; text-align: right; border-bottom: 1px solid #ddd }
th:first-child, td:first-child { text-align: left } img { max-width: 100% } .careful { background: #fff3e0; padding:
.5rem 1rem }
"""


def page(
    title: str,
    rows: list[dict[str, str]],
    careful: list[str],
    notes: list[str],
    figures: Sequence[Figure],
) -> str:
    """Return HTML with everything inside it."""
    parts = [f"<h1>{escape(title)}</h1>"]
    parts += [f'<p class="careful">{escape(text)}</p>' for text in careful]
    if rows:
        head = "".join(f"<th>{escape(name)}</th>" for name in rows[0])
        body = "".join(
            "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row.values()) + "</tr>"
            for row in rows
        )
        parts.append(f'<div class="wide"><table><tr>{head}</tr>{body}</table></div>')
    parts += [f"<p>{escape(text)}</p>" for text in notes]
    parts += [
        f'<img alt="figure" src="data:image/png;base64,{_png(figure)}">' for figure in figures
    ]
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{escape(title)}</title>'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<style>{_STYLE}</style><body>{''.join(parts)}</body></html>\n"
    )


def _png(figure: Figure) -> str:
    file = BytesIO()
    figure.savefig(file, format="png")
    return b64encode(file.getvalue()).decode("ascii")
