"""The tables of the rivals at their best, beside `ebac`: hands, energy, parameters, Z-width."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from printed import NOISE, Printed, Row, code, fixed, millijoules, of_two, table

import ebac
from ebac.laws.variant import shown_value
from ebac.studies.tuning import RANGES, TUNING_CONDITIONS
from ebac.studies.tuning.result import rows_of
from ebac.studies.zwidth.result import CRITERIA

#: Simple laws on the observer; of the parameter sets of each the best counts. The first is what `ebac tune` found.
SWEPT: dict[str, list[ebac.Variant | str]] = {
    "direct": ["direct"],
    "tca-damped": [
        "tca-damped-tuned-observer",
        *(
            ebac.Variant("tca-damped", {"virtual_damping": damping, "kp": 0.0})
            for damping in (30.0, 60.0, 90.0, 120.0)
        ),
    ],
    "lag-compensator": [
        "lag-compensator-tuned-observer",
        *(
            ebac.Variant(
                "lag-compensator",
                {"stiffness": stiffness, "virtual_damping": damping, "recovery_time": time},
            )
            for stiffness in (8e3, 16e3)
            for damping in (110.0, 130.0)
            for time in (0.02, 0.03)
        ),
    ],
    "passivity-control": [
        "passivity-control-tuned-observer",
        *(ebac.Variant("passivity-control", {"cap": cap, "reference": True}) for cap in (1.0, 3.0)),
    ],
    "virtual-coupling": [
        "virtual-coupling-tuned-observer",
        *(
            ebac.Variant("virtual-coupling", {"coupling_stiffness": 60e3, "coupling_damping": c})
            for c in (10.0, 100.0)
        ),
    ],
    "iss": ["iss-tuned-observer"],
    "eba-account": ["eba-account-tuned-observer", "eba-account"],
    "force-bounding": ["force-bounding"],
}
#: Parameters of a lag compensator that were chosen for the area of its walls, not for hands: on the encoder by a hill
#: climb for each delay, on the observer by trying a few, which fill the map at every delay.
FOR_THE_AREA = {
    "no": (
        "stiffness=2653,virtual_damping=1.39,recovery_time=0.2685",
        "stiffness=1942,virtual_damping=3.311,recovery_time=0.292",
        "stiffness=1488,virtual_damping=4.783,recovery_time=0.3073",
    ),
    "yes": ("stiffness=5000,virtual_damping=64,recovery_time=0.73",),
}
SIMPLE, WIDEST = "lag-compensator", "lag-compensator, for the area"
#: The walls of that comparison: damping [N s/m], and rungs of the ladder of stiffness.
WALLS: dict[str, Any] = {"dampings": (0.0, 10.0, 20.0), "rungs": 16}
#: Random hands of each family on each wall, and the reserve of `ebac` [J] that none of them may exceed.
EXPLORERS, RESERVES = 30, (2e-3, 3e-3, 5e-3, 10e-3)
LET_GO, PUMPING = ("slow-let-go", "slow-let-go-d2", "slow-let-go-K20"), "pumping"
DELAYS = (0, 1, 2)
#: Conditions in which hands sway, or press slowly, and what a table calls them.
SWAYS = {
    "slow-waves": "sways at 10 kN/m",
    "slow-waves-K20": "sways at 20 kN/m",
    "slow-press-d2K20": "presses slowly, 20 kN/m, 2 samples",
}


@dataclass(frozen=True, kw_only=True)
class Form:
    """A way to run laws: on the observer's estimate or on the encoder alone.

    Attributes
    ----------
    word : str
        What a table says of it.
    ending : str
        Of the names of the laws that were tuned so.
    rivals, own : str
        The options that run them so, and `ebac`.
    """

    word: str
    ending: str
    rivals: str
    own: str

    def rows(self) -> list[Row]:
        """Return what the package keeps of the search."""
        name = "tuned_rivals_observer" if "observer" in self.ending else "tuned_rivals"
        file = Path(ebac.laws.__file__).with_name(f"{name}.json")
        rows: list[Row] = json.loads(file.read_text("utf-8"))["rows"]
        return rows

    def of(self, law: str, printed: Printed) -> list[Row]:
        """Return how a tuned law, or `ebac`, does on the test hands, under one condition after the other."""
        tuned = law != "ebac"
        device = ebac.Device(sensor=ebac.ForceSensor(noise=0.03))
        observed: Any = "every-law" if tuned else True
        base = ebac.Scenario(device=device, observer=observed if self.word == "yes" else False)
        name = f"{law}{self.ending}" if tuned else law
        found = ebac.study(
            ebac.Operators.grid(), name, TUNING_CONDITIONS, base=base, threads=printed.threads
        )
        return [asdict(row) for row in rows_of(found, name)]


FORMS = (
    Form(word="no", ending="-tuned", rivals=NOISE, own=f"{NOISE} --no-observer"),
    Form(word="yes", ending="-tuned-observer", rivals=f"{NOISE} --observer-every-law", own=NOISE),
)


def tuned(printed: Printed) -> str:
    """Every law tuned, on the test hands of `ebac tune`, `ebac` as designed: hands, ripple and energy."""
    heads = [
        "law",
        "observer",
        "good of 360",
        "settled, median [s]",
        "force swing [N]",
        "impact [mJ]",
        "let go [mJ]",
        "pumping [mJ]",
        "worst hand [mJ]",
    ]
    rows = [
        [code(law), form.word, *_all_six(parts),
         *_given_out(printed, f"{law}{form.ending}", form.rivals, parts)]
        for law in RANGES
        for form in FORMS
        for parts in (form.of(law, printed),)
    ]  # fmt: skip
    for form in FORMS:
        own = form.of("ebac", printed)
        given_out = _given_out(printed, "ebac", form.own, own)
        rows.append([code("ebac"), form.word, *_all_six(own), *given_out])
    return table(heads, rows)


def tuned_cells(printed: Printed) -> str:
    """The good hands of the same, condition by condition."""
    heads = ["law", "observer", *(code(name) for name in TUNING_CONDITIONS)]
    found = [(law, form, form.of(law, printed)) for law in (*RANGES, "ebac") for form in FORMS]
    rows = [
        [code(law), form.word, *(_counts([part]) for part in parts)] for law, form, parts in found
    ]
    return table(heads, rows)


def tuned_impact(printed: Printed) -> str:
    """How soon and how stiff the tuned laws on the observer are, condition by condition."""
    form = FORMS[1]
    rows = [
        [code(law), *(_met(part) for part in form.of(law, printed))] for law in (*RANGES, "ebac")
    ]
    return table(["law", *(code(name) for name in TUNING_CONDITIONS)], rows)


def _met(part: Row) -> str:
    return f"{part['settled_in_time']}, {100 * (part['median_impact_share'] or 0):.0f} %"


def tuned_sways(printed: Printed) -> str:
    """The best rivals and `ebac` with hands that sway, or press slowly."""
    laws = ("tca-damped-tuned-observer", "lag-compensator-tuned-observer", "ebac")
    rows = printed.rows(f"study -c {','.join(SWAYS)} {NOISE} --law {','.join(laws)}")
    return table(
        ["law", *SWAYS.values()],
        [[code(law), *(_swayed(row) for row in rows if row["law"] == law)] for law in laws],
    )


def _swayed(row: Row) -> str:
    drawn = 1e3 * (row["most_drawn_J"] or 0)
    return (
        f"{of_two(row['good'], row['exact_and_still'])}, {row['settled_in_time']}; "
        f"{fixed(drawn, 0 if drawn > 10 else 1)} mJ"
    )


def _all_six(parts: list[Row]) -> list[str]:
    settled, ripple = (
        [part[key] for part in parts if part[key] is not None]
        for key in ("median_settled_s", "force_swing_N")
    )
    return [
        _counts(parts),
        " to ".join(dict.fromkeys(f"{of(settled):.2f}" for of in (min, max))) if settled else "-",
        f"{max(ripple):.1f}" if ripple else "-",
    ]


def _counts(parts: list[Row]) -> str:
    """Return good hands, and those that are exact and still, once where they are the same."""
    return of_two(*(sum(part[key] for part in parts) for key in ("good", "exact_and_still")))


def _given_out(printed: Printed, law: str, how: str, impacts: list[Row]) -> list[str]:
    """Return the least energy on impact, when let go, under pumping, and with the worst hand."""
    conditions = ",".join((*LET_GO, PUMPING))
    *let_go, pumping = (
        row["least_energy_J"] for row in printed.rows(f"study -c {conditions} {how} --law {law}")
    )
    worst = printed.rows(f"worst --evaluations 150 {how} --law {law}")
    drawn = max(row["energy_drawn_J"] for row in worst)
    impact = min(part["least_energy_J"] for part in impacts)
    return [
        millijoules(impact),
        millijoules(min(let_go)),
        millijoules(pumping),
        millijoules(-drawn),
    ]


def tuned_values(printed: Printed) -> str:
    """The parameters that were found, for each delay."""
    del printed  # they are kept in the package
    rows = []
    for law in RANGES:
        for form in FORMS:
            found = {r["delay"]: r["changes"] for r in form.rows() if r["law"] == law}
            rows.append([code(law), form.word, *(_values(found[delay]) for delay in DELAYS)])
    return table(["law", "observer", *(f"d = {delay}" for delay in DELAYS)], rows)


def _values(changes: Row) -> str:
    shown = (f"{name} = {shown_value(value)}" for name, value in changes.items())
    return ", ".join(shown) or "as designed"


def z_width(printed: Printed) -> str:
    """Areas under the borders of the tuned laws and of `ebac`."""
    runs = {
        **{("direct", form.word): f"{form.rivals} --law direct" for form in FORMS},
        **{(law, form.word): f"{form.rivals} --law {law}{form.ending}" for law in RANGES for form in FORMS},
        **{("ebac", form.word): f"{form.own} --law ebac" for form in FORMS},
    }  # fmt: skip
    found = {key: printed.document(f"zwidth {how}") for key, how in runs.items()}
    scores = {
        (*key, score["delay_samples"]): score for key in found for score in found[key]["scores"]
    }
    for form in FORMS:
        changes = " ".join(f"--change {values}" for values in FOR_THE_AREA[form.word])
        widest = printed.document(f"zwidth {form.rivals} --law {SIMPLE} {changes}")["scores"]
        for d in DELAYS:
            several = [s for s in widest if s["delay_samples"] == d and s["law"] != SIMPLE]
            scores[WIDEST, form.word, d] = max(several, key=lambda s: float(s["usable_area"]))
    laws = list(dict.fromkeys(law for law, _ in runs))
    laws.insert(laws.index(SIMPLE) + 1, WIDEST)
    heads = ["law", *(f"{on}, d = {d}" for on in ("encoder", "observer") for d in DELAYS)]
    parts = []
    for name in reversed(CRITERIA):
        rows = [
            [_named(law), *(f"{scores[law, form.word, d][f'{name}_area'] / 1e3:.0f}" for form in FORMS for d in DELAYS)]
            for law in laws
        ]  # fmt: skip
        parts.append(f"**{name.capitalize()}** [kN/m N s/m].\n\n{table(heads, rows)}")
    return "\n\n".join([*parts, _best(scores), _ceilings(found["direct", "no"])])


def _named(law: str) -> str:
    name, comma, more = law.partition(",")
    return f"{code(name)}{comma}{more}"


def z_width_explored(printed: Printed) -> str:
    """Usable areas, without and with random hands, none of which may draw more than the reserve of `ebac`."""
    device = ebac.Device(sensor=ebac.ForceSensor(noise=0.03))
    base = ebac.Scenario(device=device, seconds=3.0, observer="every-law")

    def areas(laws: Sequence[ebac.Variant | str], energy: float) -> NDArray[np.float64]:
        """Return the largest of some laws: without and with random hands, for every delay."""
        named = {str(i): law for i, law in enumerate(laws)}
        found = [
            ebac.zwidth(
                named, base=base, hands=hands, epsilon=energy, threads=printed.threads, **WALLS
            )
            for hands in (0, EXPLORERS)
        ]
        return np.array(
            [[max(z.area("usable", law, d) for law in z.laws) for d in DELAYS] for z in found]
        )

    best = {law: areas(variants, RESERVES[0]) for law, variants in SWEPT.items()}
    rows = [[code(law), str(len(SWEPT[law])), "2", *_pairs(found)] for law, found in best.items()]
    for reserve in RESERVES:
        found = areas([ebac.Variant("ebac", {"observed_reserve": reserve})], reserve)
        best.setdefault("ebac", found)
        rows.append([code("ebac"), "1", f"{1e3 * reserve:g}", *_pairs(found)])
    heads = ["law", "parameter sets", "energy [mJ]", *(f"d = {d}" for d in DELAYS)]
    return f"{table(heads, rows)}\n\n{_compared({law: found[1] for law, found in best.items()})}"


def _pairs(areas: NDArray[np.float64]) -> list[str]:
    """Return areas without and with random hands in kN/m N s/m."""
    return [
        f"{pressed / 1e3:.0f}\u00a0/\u00a0{explored / 1e3:.0f}" for pressed, explored in areas.T
    ]


def _compared(best: dict[str, NDArray[np.float64]]) -> str:
    parts = []
    for i, delay in enumerate(DELAYS):
        law = max(SWEPT, key=lambda name, i=i: best[name][i])
        ours, theirs = best["ebac"][i] / 1e3, best[law][i] / 1e3
        parts.append(
            f"{fixed(ours / theirs, 1)} at d = {delay} ({code(law)}: {theirs:.0f}, `ebac`: {ours:.0f})"
        )
    return (
        "Usable area of `ebac` with 2 mJ over that of the best simple law with the observer, random hands included: "
        f"{', '.join(parts)}."
    )


def _best(scores: dict[tuple[str, str, int], Row]) -> str:
    """Compare the usable area of `ebac` with the best simple law, on the observer and on the encoder alone."""

    def area(key: tuple[str, str, int]) -> float:
        return float(scores[key]["usable_area"])

    def rounded(value: float) -> str:
        return fixed(value, 2 if value < 10 else 1 if value < 100 else 0)

    def compared(delay: int, word: str) -> str:
        laws = {law for law, form, d in scores if (form, d) == (word, delay)} - {"ebac"}
        best = max(sorted(laws), key=lambda law: area((law, word, delay)))
        theirs, ours = area((best, word, delay)), area(("ebac", "yes", delay))
        return (
            f"{rounded(ours / theirs)} at d = {delay} "
            f"({_named(best)}: {rounded(theirs / 1e3)}, `ebac`: {rounded(ours / 1e3)})"
        )

    def sentence(name: str, word: str) -> str:
        found = ", ".join(compared(delay, word) for delay in DELAYS)
        return f"Usable area of `ebac` over that of the best simple law {name}: {found}."

    return f"{sentence('with the observer', 'yes')}\n\n{sentence('on the encoder alone', 'no')}"


def _ceilings(found: Row) -> str:
    rows, top = found["rows"], found["most_stiffness_N_per_m"]
    linear, passive = [], []
    for d in DELAYS:
        of = [r for r in rows if r["delay_samples"] == d and r["law"] == "direct"]
        at = [r["damping_Ns_per_m"] for r in of]
        limits = [min(r["spectral_N_per_m"], top) for r in of]
        linear.append(fixed(float(np.trapezoid(limits, at)), 0, 1e-3))
        passive.append(f"{of[0]['passive_N_per_m'] / 1e3:.2g}")
    return (
        f"Ceilings: the linear loop without a law (spectral radius below 1) has {', '.join(linear)} at d = 0, 1, 2; "
        f"a wall without damping is passive without a law up to {', '.join(passive)} kN/m where the current loop "
        "has no lag."
    )
