"""Parameter classes of the core: what `inspect.signature` shows, and what a wrong call is told."""

import inspect
import re
from typing import Any

import pytest

import ebac
from ebac import _core

#: Every class that takes parameters by name.
CLASSES = {
    name: value
    for name, value in vars(_core).items()
    if isinstance(value, type) and not name.startswith("_") and hasattr(value, "__signature__")
}


#: Parameters that are short for another, and that a value does not have; a model it has where one was given.
SHORT = {ebac.Hand: ("target", "model")}


def of(cls: type) -> list[str]:
    return list(inspect.signature(cls).parameters)


def test_laws_devices_hands_and_worlds_are_among_them() -> None:
    assert CLASSES.keys() >= {
        "EBAC",
        "TCA",
        "Direct",
        "Device",
        "Hand",
        "Step",
        "Recorded",
        "Corner",
    }
    assert CLASSES.keys() >= {"Free", "Wall", "Timing", "Port", "Limits", "RealTime", "Gimbal"}


def test_signature_has_the_fields_by_name_with_their_defaults(of_each: Any) -> None:
    def check(cls: Any) -> None:
        shown = [
            p
            for p in inspect.signature(cls).parameters.values()
            if p.name not in SHORT.get(cls, ())
        ]
        assert all(p.kind is inspect.Parameter.KEYWORD_ONLY for p in shown)
        if cls is ebac.Recorded:
            return
        made = cls()
        assert [p.name for p in shown] == list(made.as_dict())
        for parameter in shown:
            assert repr(parameter.default) == repr(getattr(made, parameter.name))
        assert cls(**{p.name: p.default for p in shown}) == made or cls is ebac.Port

    of_each(CLASSES, check)


def test_a_value_without_a_name_is_refused_with_the_names(of_each: Any) -> None:
    def check(cls: Any) -> None:
        with pytest.raises(TypeError, match=re.escape(f"{cls.__name__}(1.5): takes")) as caught:
            cls(1.5)
        assert all(name in str(caught.value) for name in of(cls))

    of_each(CLASSES, check)


def test_an_unknown_name_is_refused_with_the_nearest(of_each: Any) -> None:
    def check(cls: Any) -> None:
        names = of(cls)
        wrong = names[0] + "x" if names else "x"
        given = {"t": [0.0], "x": [0.0]} if cls is ebac.Recorded else {}
        if wrong in given:
            wrong = "tt"
        with pytest.raises(TypeError, match=f"{cls.__name__} has no parameter '{wrong}'") as caught:
            cls(**given, **{wrong: 1})
        assert all(name in str(caught.value) for name in names)
        if len(wrong) > 3:
            assert f"did you mean '{names[0]}'" in str(caught.value)

    of_each(CLASSES, check)


def test_a_value_of_another_type_is_refused_by_name(of_each: Any) -> None:
    def check(cls: Any) -> None:
        given = {"t": [0.0], "x": [0.0]} if cls is ebac.Recorded else {}
        for name in of(cls):
            with pytest.raises(
                TypeError, match=re.escape(f"{cls.__name__}.{name} = {{'a': 1}}: must be")
            ):
                cls(**given | {name: {"a": 1}})

    of_each(CLASSES, check)


def test_a_law_is_designed_from_a_device_and_a_timing() -> None:
    with pytest.raises(
        TypeError, match=re.escape("EBAC.design: facts = 3: must be a Device or DeviceFacts")
    ):
        ebac.EBAC.design(3, ebac.Timing())  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=re.escape("EBAC.design: timing = 3: must be a Timing")):
        ebac.EBAC.design(ebac.Device(), 3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="EBAC has no parameter 'dampin', did you mean 'damping'"):
        ebac.EBAC.design(ebac.Device(), ebac.Timing(), dampin=3)


def test_a_law_steps_on_a_port() -> None:
    with pytest.raises(TypeError, match=re.escape("step: port = 1.0: must be a Port")):
        ebac.EBAC().step(1.0)  # type: ignore[arg-type]


def test_nobody_makes_the_state_of_a_law() -> None:
    with pytest.raises(TypeError, match="it is `state` of a law"):
        ebac.EBAC.State()


def test_a_law_has_no_other_attributes() -> None:
    with pytest.raises(AttributeError):
        ebac.EBAC().anything = 1  # type: ignore[attr-defined]
