"""What errors of force sensor and motor cost `ebac`: noise, bias, delay, scale, steps; ripple, cogging, offset."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from held_tables import Held
from printed import NOISY, Printed, Row, of_two, table

import ebac

#: From so many lost hands of 60 on a count is bold.
LOST = 9
#: Energy in a window of time from which on it is named [J].
NAMED = 0.5e-3


def scenario(*, sensor: dict[str, Any] | None = None, **parts: Any) -> ebac.Scenario:
    """Return the reference scenario with 0.03 N of noise, an error of its sensor, and other parts of its device."""
    made = NOISY.device.sensor.replace(**(sensor or {}))
    return ebac.Scenario(device=ebac.Device(sensor=made, **parts))


# --- its noise ---

#: Noises of the sensor [N], and how long five hands press on four walls with each of them [s].
NOISES, HELD_FOR = (0.03, 0.06, 0.1, 0.15, 0.2, 0.5), 300.0
PRESSING = [
    Held(mass, damping, stiffness, (wall, delay))
    for mass, damping, stiffness in (
        (0.05, 20, 100),
        (1, 20, 100),
        (0.754, 36, 134),
        (0.15, 6, 300),
        (0.3, 6, 1000),
    )
    for wall in (1e4, 2e4)
    for delay in (1, 2)
]


def noise(printed: Printed) -> str:
    """Hands that press for 300 s: how many keep their wall and the observer; what the worst hand draws."""
    rows = []
    for size in NOISES:
        found = printed.kept(f"noise-{size:g}", partial(_pressed, size))
        fell = [row["fell_s"] for row in found if row["fell_s"] is not None]
        worst = printed.rows(f"worst --device-noise {size:g} -c d2K20 --seed 1")
        rows.append(
            [
                f"{size:g} N",
                str(sum(row["kept"] for row in found)),
                str(sum(row["on_encoder"] for row in found)),
                f"{min(fell):.1f} s" if fell else "none",
                f"{1e3 * max(row['energy_drawn_J'] for row in worst):.1f} mJ",
            ]
        )
    heads = [
        "noise of the sensor",
        f"exact and still at the end, of {len(PRESSING)}",
        "on the encoder at the end",
        "first fallback",
        "drawn by the worst hand (`ebac worst -c d2K20`)",
    ]
    return table(heads, rows)


def _pressed(size: float) -> list[Row]:
    found = []
    for one in PRESSING:
        run = one.scenario(seed=1).replace(
            device=scenario(sensor={"noise": size}).device, seconds=HELD_FOR
        )
        trace = ebac.simulate(run, "ebac")
        fallback = np.flatnonzero(trace.axis("est.fallback"))
        contact = ebac.contact(trace)
        found.append(
            {
                "kept": bool(contact.exact and contact.still),
                "on_encoder": bool(trace.axis("est.fallback")[-1]),
                "fell_s": float(trace["t"][fallback[0]]) if len(fallback) else None,
            }
        )
    return found


# --- a bias, and a delay that is not declared ---

#: Biases [N] and delays [s] of a row; runs of each family of the search.
WRONG, RUNS = ((0.0, 0.0), (0.1, 0.5e-3), (0.2, 1e-3), (0.5, 2e-3)), 1000


def bias(printed: Printed) -> str:
    """What the worst hand draws where the force is biased, or later than the loop knows."""
    rows = []
    for offset, late in WRONG:
        row = []
        for label, error in (
            (f"{offset:g} N", {"bias": offset}),
            (f"{1e3 * late:g} ms", {"delay": late}),
        ):
            name = "-".join(f"{kind}-{value:g}" for kind, value in error.items())
            base = scenario(sensor=error)
            row += [label, _worst(printed, name, base, ("d1K10",), RUNS, SEEDS)]
        rows.append(row)
    return table(["bias", "draws", "delay that is not declared", "draws"], rows)


#: Biases [N], and how long the hands wait before they move [s]; the wall [N/m].
BIASES, WAITS, IMPACT = (0.0, 0.2, 0.3, 1.0, 2.0), (0.0, 0.1, 0.3, 1.0), 2e4


def learned_bias(printed: Printed) -> str:
    """The stiffness on impact of the first contact, where hands wait before they move."""
    rows = []
    for offset in BIASES:
        found = printed.kept(f"bias-learned-{offset:g}", partial(_touched, offset))
        rows.append([f"{offset:g} N", *(f"{100 * one['impact_share']:.0f} %" for one in found)])
    waits = ("at once", *(f"after {wait:g} s" for wait in WAITS[1:]))
    return table(["bias", *(f"the hand moves {wait}" for wait in waits)], rows)


def _touched(offset: float) -> list[Row]:
    wall = ebac.Wall(stiffness=IMPACT, position=0.01)
    found = []
    for wait in WAITS:
        base = scenario(sensor={"bias": offset}).replace(environment=wall, seconds=1.0 + wait)
        traces = []
        for one in ebac.Operators.grid().scenarios(base):
            path = [ebac.Step(target=one.hand.path[0].target, at=wait)]
            traces.append(ebac.simulate(one.replace(hand=one.hand.replace(path=path)), "ebac"))
        shares = [ebac.contact(trace).impact_share for trace in traces]
        found.append({"impact_share": float(np.median(shares))})
    return found


# --- the scale of the force ---

#: Scales of the force sensor, over the true one.
SCALES = (1.0, 0.998, 0.99, 0.98, 0.95, 1.01, 1.02, 1.05)
SCALED = ("slow-waves", "slow-waves-K20", "slow-press-d2K20", "d2K20")
#: Seeds of the noise, and of the search.
SEEDS = (1, 2)


def scale(printed: Printed) -> str:
    """Hands that are exact and still where the scale of the force is wrong, and what is drawn."""
    rows = []
    for factor in SCALES:
        name, base = f"scale-{factor:g}", scenario(sensor={"scale": factor})
        cells = [
            _lost([str(r["exact_and_still"]) for r in of], [r["exact_and_still"] for r in of])
            + _window(of, ";")
            for of in _counted(printed, name, base, SCALED)
        ]
        rows.append([_said(factor), *cells, _worst(printed, name, base, ("d1K10",), 300, SEEDS)])
    heads = [
        "what the sensor shows",
        "sways at 10 kN/m",
        "sways at 20 kN/m",
        "presses slowly, 20 kN/m, 2 samples",
        "presses at once, 20 kN/m, 2 samples",
        "worst hand",
    ]
    return table(heads, rows)


def _said(factor: float) -> str:
    if factor == 1:
        return "exact"
    return f"{100 * abs(factor - 1):.2g} % too {'much' if factor > 1 else 'little'}"


# --- the steps of the sensor ---

#: Steps of the reading [N].
STEPS = (0.0, 0.0625, 0.125, 0.25)


def steps(printed: Printed) -> str:
    """Hands that are good, and exact and still, with a force in steps."""
    rows = []
    for step in STEPS:
        base = scenario(sensor={"quantum": step})
        counted = _counted(printed, f"step-{step:g}", base, ("d1K10", "d2K20", "slow-waves"))
        rows.append([f"{step:g} N" if step else "none", *map(_both, counted)])
    heads = ["step", "10 kN/m, 1 sample", "20 kN/m, 2 samples", "sways at 10 kN/m"]
    return table(heads, rows)


# --- the torque of the motor ---

RATED = ebac.Motor().rated_torque
#: Errors of the motor and its amplifier: what they are called, and what they are.
MOTORS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("none", {}),
    ("ripple of 0.25 %, 13 times a turn", {"motor": ebac.Motor(ripple=0.0025, waves=13)}),
    ("0.5 %, 13 times", {"motor": ebac.Motor(ripple=0.005, waves=13)}),
    ("0.5 %, 26 times", {"motor": ebac.Motor(ripple=0.005, waves=26)}),
    ("1 %, 13 times", {"motor": ebac.Motor(ripple=0.01, waves=13)}),
    ("1 %, 26 times", {"motor": ebac.Motor(ripple=0.01, waves=26)}),
    ("2 %, 26 times", {"motor": ebac.Motor(ripple=0.02, waves=26)}),
    (
        "cogging of 0.1 % of the rated torque (0.01 N)",
        {"motor": ebac.Motor(cogging=1e-3 * RATED, waves=26)},
    ),
    ("cogging of 0.5 % (0.05 N)", {"motor": ebac.Motor(cogging=5e-3 * RATED, waves=26)}),
    ("offset of 10 mA (0.11 N)", {"drive": ebac.Drive(current_offset=0.01)}),
    ("noise of 5 mA (0.05 N)", {"drive": ebac.Drive(current_noise=5e-3)}),
)
TURNED = ("d1K10", "d2K20", "slow-waves", "slow-press-d2K20")


def motor(printed: Printed) -> str:
    """Hands that are good, and exact and still, with an uneven torque; what the worst hands of two walls draw."""
    rows = []
    for i, (label, parts) in enumerate(MOTORS):
        base = scenario(**parts)
        counted = _counted(printed, f"motor-{i}", base, TURNED, seeds=(1,))
        cells = [_both(of) + _window(of, ",") for of in counted]
        rows.append(
            [label, *cells, _worst(printed, f"motor-{i}", base, ("d1K10", "d2K20"), 600, (1,))]
        )
    heads = [
        "error of the motor",
        "10 kN/m, 1 sample",
        "20 kN/m, 2 samples",
        "sways at 10 kN/m",
        "presses slowly, 20 kN/m, 2 samples",
        "worst hands at the first two walls",
    ]
    return table(heads, rows)


# --- what they share ---


def _counted(
    printed: Printed,
    name: str,
    base: ebac.Scenario,
    conditions: Sequence[str],
    seeds: Sequence[int] = SEEDS,
) -> list[list[Row]]:
    """Return for each condition the row of a study with each seed of the noise."""
    by_seed = [printed.studied(f"{name}-study-{seed}", conditions, base, seed) for seed in seeds]
    return [list(rows) for rows in zip(*by_seed, strict=True)]


def _worst(
    printed: Printed,
    name: str,
    base: ebac.Scenario,
    conditions: Sequence[str],
    runs: int,
    seeds: Sequence[int],
) -> str:
    """Return what the worst hand draws in each condition, with each seed of the search."""

    def searched(condition: str, seed: int) -> list[Row]:
        return ebac.worst(
            "ebac", condition, evaluations=runs, seed=seed, base=base, threads=printed.threads
        ).rows()

    found = [
        printed.kept(f"{name}-worst-{c}-{seed}", partial(searched, c, seed))
        for c in conditions
        for seed in seeds
    ]
    return f"{_most(found, 'energy_drawn_J')} mJ"


def _most(found: Sequence[Sequence[Row]], key: str) -> str:
    """Return the largest energy of each search [mJ]."""
    return ", ".join(f"{1e3 * max(row[key] for row in rows):.1f}" for rows in found)


def _both(rows: Sequence[Row]) -> str:
    """Return how many are good / exact and still, of each seed."""
    texts = [of_two(r["good"], r["exact_and_still"]) for r in rows]
    return _lost(list(dict.fromkeys(texts)), [r["exact_and_still"] for r in rows])


def _lost(texts: Sequence[str], counts: Sequence[int]) -> str:
    joined = ", ".join(texts)
    return f"**{joined}**" if min(counts) <= 60 - LOST else joined


def _window(rows: Sequence[Row], mark: str) -> str:
    """Return the most that a hand draws in a window of time, where it is worth a word."""
    most = max(r["most_drawn_J"] for r in rows)
    return f"{mark} {1e3 * most:.0f} mJ" if most >= NAMED else ""
