"""Wrong calls of studies, sweeps, maps and searches are refused with the thing and its value, before anything runs."""

from collections.abc import Callable
from typing import Any

import pytest

import ebac

E: Any = ebac
HANDS = ebac.Operators.sample(1, 1)
SHORT = ebac.Scenario(seconds=0.3)

WRONG: dict[str, tuple[Callable[[], Any], type[Exception], str]] = {
    "base": (
        lambda: E.study(HANDS, ["tca"], base="x"),
        TypeError,
        "ebac.study takes a Scenario as its base, not 'x' (str)",
    ),
    "base of worst": (
        lambda: E.worst("tca", base=3, evaluations=40),
        TypeError,
        "ebac.worst takes a Scenario as its base, not 3 (int)",
    ),
    "no family": (
        lambda: E.worst("tca", family=[], evaluations=40),
        ValueError,
        "worst: family = []: is empty; give one at least",
    ),
    "evaluations": (
        lambda: E.worst("tca", evaluations=40.5),
        TypeError,
        "worst: evaluations = 40.5: must be a whole number",
    ),
    "seed": (
        lambda: E.worst("tca", seed=1.5, evaluations=40),
        TypeError,
        "worst: seed = 1.5: must be a whole number",
    ),
    "pull rate": (
        lambda: E.worst("tca", pull_rate="a", evaluations=40),
        TypeError,
        "worst: pull_rate = 'a': must be a number",
    ),
    "executor": (
        lambda: E.sweep([SHORT], ["tca"], executor=3),
        TypeError,
        "ebac.sweep takes an executor of concurrent.futures, not 3 (int)",
    ),
    "a map of two laws": (
        lambda: E.stability_map(["tca", "ebac"], base=SHORT),
        ValueError,
        "stability_map: law = tca, ebac: a map is of one law; make one of each",
    ),
    "rungs": (
        lambda: E.zwidth("direct", base=SHORT, rungs=2.5),
        TypeError,
        "zwidth: rungs = 2.5: must be a whole number",
    ),
    "hands of a Z-width": (
        lambda: E.zwidth("direct", base=SHORT, hands=1.5),
        TypeError,
        "zwidth: hands = 1.5: must be a whole number",
    ),
    "nothing to tune under": (
        lambda: E.tune("tca-damped", []),
        ValueError,
        "no condition given: tune needs at least one",
    ),
    "an empty population": (
        lambda: E.ablation([]),
        TypeError,
        "ebac.study takes a population, an Operators, not [] (list)",
    ),
    "seed of a study": (
        lambda: E.study(HANDS, "direct", base=SHORT, seed=[]),
        TypeError,
        "study: seed = []: must be a whole number",
    ),
    "seed of a search": (
        lambda: E.tune("tca-damped", ["d1K10"], seed=[]),
        TypeError,
        "seed = []: must be a whole number",
    ),
    "no ranges": (
        lambda: E.tune("tca-damped", ranges=3.0),
        TypeError,
        "ebac.tune takes ranges by name, as {'kp': (0.1, 10)}, not 3.0 (float)",
    ),
    "no condition": (
        lambda: E.study(HANDS, "direct", [1.5]),
        TypeError,
        "ebac.study takes conditions by name, not 1.5 (float)",
    ),
    "no stiffness": (
        lambda: E.stiffest("direct", stiffnesses=["x"]),
        TypeError,
        "stiffnesses = 'x': must be a number",
    ),
    "no share": (
        lambda: E.stiffest("direct", share=None),
        TypeError,
        "share = None: must be a number",
    ),
    "no numbers of a map": (
        lambda: E.stability_map("direct", base=SHORT, ys=["x", "y"]),
        TypeError,
        "stability_map: ys = 'x': must be a number",
    ),
    "no dampings of a Z-width": (
        lambda: E.zwidth("direct", base=SHORT, dampings={}),
        ValueError,
        "zwidth: dampings = []: is empty; give one at least",
    ),
    "no rates": (
        lambda: E.engines(["direct"], rates=["x"]),
        TypeError,
        "engines: rates = 'x': must be a number",
    ),
    "one law of a tissue, letter by letter": (
        lambda: E.tissue("direct"),
        TypeError,
        "tissue: laws = 'direct' (str): must be a sequence, such as ['direct']",
    ),
    "materials": (
        lambda: E.tissue(chosen=3),
        TypeError,
        "ebac.tissue takes materials by name, not 3 (int)",
    ),
    "shapes of bytes": (
        lambda: E.shapes(["direct"], worlds=["plane"], stiffnesses=b"x"),
        TypeError,
        "stiffnesses = b'x' (bytes): must be a sequence, such as [b'x']",
    ),
    "laws beside": (
        lambda: E.ablation(beside=None),
        TypeError,
        "ablation: beside = None (NoneType): must be a sequence, such as [None]",
    ),
    "a name of an ablation": (
        lambda: E.ablation(thread=1),
        TypeError,
        "ebac.ablation has no parameter 'thread', did you mean 'threads'; it has: population, law, changes, beside, "
        "measures, base, seed, threads, executor, out, resume, progress",
    ),
    "measures": (
        lambda: E.ablation(measures=["good"]),
        TypeError,
        "ebac.ablation takes measures, of ebac.studies.MEASURES, not 'good' (str)",
    ),
    "folder": (
        lambda: E.sweep([SHORT], ["direct"], out={}),
        TypeError,
        "ebac.sweep takes the path of a folder as out, not {} (dict)",
    ),
    "designed for": (
        lambda: E.sweep([SHORT], ["direct"], designed_for=3),
        TypeError,
        "designed_for takes pairs of Device or DeviceFacts, and Timing, not 3 (int)",
    ),
    "training": (
        lambda: E.tune("tca-damped", training=3),
        TypeError,
        "ebac.tune takes populations, each an Operators, not 3 (int)",
    ),
    "range": (
        lambda: E.tune("tca-damped", ranges={"kp": (1, 0)}),
        ValueError,
        "kp from 1 to 0: must lie in [0, 10], the lower one first",
    ),
    "law by name of worst, twice": (
        lambda: E.worst("tca", law="eba"),
        TypeError,
        "ebac.worst: law is given twice, as 'tca' and by name",
    ),
    "tune without a law": (
        lambda: E.tune(hand=1),
        TypeError,
        "ebac.tune has no parameter 'hand'; it has: law, conditions, training, test, ranges, base, evaluations, seed, "
        "threads, progress",
    ),
}

#: A name that is not taken, and what follows it.
NAMES = {
    (
        "tune",
        "hands",
    ): ": give training=ebac.Operators.sample(24, 14), 24 random hands of seed 14; it has: law, ",
    ("worst", "familly"): ", did you mean 'family'; it has: law, condition, family, ",
    ("study", "conditon"): ", did you mean 'conditions'",
    ("sweep", "law"): ", did you mean 'laws'",
    ("stiffest", "shares"): ", did you mean 'share'",
    ("zwidth", "rung"): ", did you mean 'rungs'",
    ("stability_map", "xss"): ", did you mean 'xs'",
    ("tissue", "law"): ", did you mean 'laws'",
    ("shapes", "world"): ", did you mean 'worlds'",
    ("engines", "rate"): ", did you mean 'rates'",
    ("random_worlds", "law"): ", did you mean 'laws'",
}


@pytest.mark.parametrize(("call", "kind", "message"), WRONG.values(), ids=WRONG)
def test_a_wrong_call_is_refused_by_name(
    call: Callable[[], Any], kind: type[Exception], message: str
) -> None:
    with pytest.raises(kind) as refused:
        call()
    assert refused.value.args[0] == message


@pytest.mark.parametrize(("function", "name"), NAMES)
def test_a_name_that_is_not_taken_is_refused_with_the_nearest(function: str, name: str) -> None:
    """Python said `tune() got an unexpected keyword argument 'hands'`."""
    with pytest.raises(TypeError) as refused:
        getattr(E, function)("tca", **{name: 4})
    begin = f"ebac.{function} has no parameter {name!r}{NAMES[function, name]}"
    assert refused.value.args[0].startswith(begin)


def test_a_run_that_is_none_of_a_study_is_refused() -> None:
    """By NumPy: an `IndexError`, and for a word a `TypeError` about string formatting."""
    study: Any = ebac.study(HANDS, ["direct", "tca"], base=SHORT)
    assert study.trace(1).law == "tca"
    for run in (-1, 2):
        with pytest.raises(ValueError, match=rf"run = {run}: must lie in \[0, 1\]"):
            study.trace(run)
    with pytest.raises(TypeError, match="run = 'a': must be a whole number"):
        study.trace("a")


def test_a_column_is_named_by_one_word() -> None:
    """A list was an unhashable type."""
    result: Any = ebac.sweep([SHORT], ["direct"])
    with pytest.raises(KeyError, match=r"no column is called \['swing_m'\]"):
        result[["swing_m"]]
    trace: Any = ebac.simulate(SHORT, "direct")
    with pytest.raises(TypeError, match=r"trace\[\['x'\]\]: must be the name of a column"):
        trace[["x"]]


def test_a_path_that_is_none_is_refused_by_name() -> None:
    trace: Any = ebac.simulate(SHORT, "direct")
    result: Any = ebac.sweep([SHORT], "direct")
    row = {"m_kg": 0.1, "b_Ns_per_m": 2, "k_N_per_m": 300, "target_m": 0.02}
    hands: Any = E.Operators(**row)
    writers = {
        "Scenario.save": E.Scenario().save,
        "Trace.to_csv": trace.to_csv,
        "Trace.to_npz": trace.to_npz,
        "SweepResult.to_csv": result.to_csv,
        "SweepResult.to_parquet": result.to_parquet,
        "Operators.to_csv": hands.to_csv,
        "Operators.from_csv": hands.from_csv,
        "StabilityMap.to_npz": E.stability_map(
            "direct", xs=[1, 2], ys=[1e3, 2e3], base=SHORT
        ).to_npz,
    }
    for name, write in writers.items():
        with pytest.raises(TypeError) as refused:
            write(3)
        assert refused.value.args[0] == f"{name} takes the path of a file, not 3 (int)"


def test_the_path_of_an_exploration_that_is_none_is_refused_by_name() -> None:
    pytest.importorskip("bokeh")
    page: Any = ebac.simulate(SHORT, "direct").explore()
    with pytest.raises(TypeError, match=r"Exploration\.save takes the path of a file, not 3"):
        page.save(3)
