"""Wrong arguments of the functions and classes of one run: a sentence of ours, never another library's."""

import inspect
from collections.abc import Callable
from typing import Any

import pytest

import ebac

S: Any = ebac.Scenario
has = "; it has: device, hand, environment, timing, seconds, jitter, seed"


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: ebac.contact("x"),  # type: ignore[arg-type]
            "ebac.contact takes a trace, as ebac.simulate or ebac.load returns it, not 'x' (str)",
        ),
        (
            lambda: ebac.simulate("x"),  # type: ignore[arg-type]
            "ebac.simulate takes a Scenario, not 'x' (str)",
        ),
        (lambda: ebac.spec_sheet(3), "ebac.spec_sheet takes a Device, not 3 (int)"),  # type: ignore[arg-type]
        (lambda: ebac.ideal_rest(3), "ebac.ideal_rest takes a Scenario, not 3 (int)"),  # type: ignore[arg-type]
        (
            lambda: ebac.study(3),  # type: ignore[arg-type]
            "ebac.study takes a population, an Operators, not 3 (int)",
        ),
        (
            lambda: ebac.sweep(3, ["ebac"]),  # type: ignore[arg-type]
            "ebac.sweep takes a list of scenarios, not 3 (int)",
        ),
        (
            lambda: ebac.zwidth("x"),  # type: ignore[arg-type]
            "ebac.zwidth takes a Scenario as its base, not 'x' (str)",
        ),
        (
            lambda: S(wall=1),
            f"Scenario has no parameter 'wall': give environment=ebac.Wall(...){has}",
        ),
        (
            lambda: S().replace(delay=2),
            "Scenario has no parameter 'delay': it belongs to Timing, timing=ebac.Timing(delay=...)"
            + has,
        ),
        (
            lambda: S(law="eba"),
            f"Scenario has no parameter 'law': a law is an argument of ebac.simulate{has}",
        ),
        (
            lambda: S(secnds=1),
            f"Scenario has no parameter 'secnds', did you mean 'seconds'{has}",
        ),
        (lambda: S(colour=1), f"Scenario has no parameter 'colour'{has}"),
        (
            lambda: S(3),
            f"Scenario takes its parameters by name, not 3 (int){has}",
        ),
        (lambda: S(device=3), "Scenario.device = 3: must be Device"),
    ],
)
def test_wrong_arguments_are_refused_with_a_sentence(
    call: Callable[[], object], message: str
) -> None:
    with pytest.raises(TypeError) as refused:
        call()
    assert str(refused.value) == message


def test_a_scenario_still_shows_its_signature() -> None:
    assert list(inspect.signature(ebac.Scenario).parameters) == [
        *("device", "hand", "environment", "timing", "seconds", "jitter", "seed")
    ]
