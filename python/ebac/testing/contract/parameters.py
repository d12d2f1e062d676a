"""Parameters are named, bounded, checked and documented, all from one field list."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ebac
from ebac.testing import strategies
from ebac.testing.contract.numbers import inherited
from ebac.testing.contract.subject import Subject, of_core


def beyond(field: Any, bound: float, way: int) -> Any:
    """Return the next value past a bound."""
    return int(bound) + way if field.kind == "int" else math.nextafter(bound, way * math.inf)


def typed(field: Any, value: float) -> Any:
    """Return a value in the type of the field."""
    return {"int": int, "bool": bool, "float": float}[field.kind](value)


def of_every_field(test: Any) -> Any:
    """Make a test of one field the test of all fields of a class, which reports every field that fails."""

    def run(self: Any, owner: Any) -> None:
        wrong = []
        for field in owner.fields():
            try:
                test(self, owner, field)
            except (Exception, pytest.fail.Exception) as failure:
                wrong.append(f"{owner.__name__}.{field.name}: {failure}")
        if wrong:
            pytest.fail("\n".join(wrong), pytrace=False)

    run.__name__, run.__doc__ = test.__name__, test.__doc__
    return run


class FieldContract:
    """What every class with a field list promises; `owners` names the classes."""

    @classmethod
    def owners(cls) -> list[Any]:
        """Return the classes whose fields are tested."""
        raise NotImplementedError(f"{cls.__name__}.owners() names no class")

    def pytest_generate_tests(self, metafunc: pytest.Metafunc) -> None:
        """Run a test once for each class."""
        if "owner" in metafunc.fixturenames:
            owners = self.owners()
            metafunc.parametrize("owner", owners, ids=[owner.__name__ for owner in owners])

    @of_core
    @of_every_field
    def test_every_parameter_has_a_unit_a_meaning_and_a_default(
        self, owner: Any, field: Any
    ) -> None:
        assert field.unit
        assert len(field.meaning) > 2
        assert not field.meaning.endswith(".")
        assert getattr(owner(), field.name) == field.default
        assert field.low <= field.default <= field.high
        assert field.name in owner.__doc__
        assert field.meaning in owner.__doc__
        assert field.meaning in getattr(owner, field.name).__doc__

    @of_core
    @of_every_field
    def test_each_bound_of_a_parameter_is_accepted(self, owner: Any, field: Any) -> None:
        for bound in filter(math.isfinite, (field.low, field.high)):
            value = typed(field, bound)
            assert getattr(owner(**{field.name: value}), field.name) == value

    @of_core
    @of_every_field
    def test_one_step_beyond_a_bound_is_refused_by_name(self, owner: Any, field: Any) -> None:
        beginning = f"{owner.__name__}.{field.name} = "
        if field.kind == "bool":  # it has no bounds, but neither are 2 and None switches
            for value in (2, None):
                with pytest.raises(TypeError) as wrong:
                    owner(**{field.name: value})
                assert f"{beginning}{value}: must be bool" in str(wrong.value)
            return
        unit = "" if field.unit == "1" else f" {field.unit}"
        for bound, way in ((field.low, -1), (field.high, 1)):
            if math.isinf(bound):
                continue
            with pytest.raises(ValueError) as caught:  # noqa: PT011
                owner(**{field.name: beyond(field, bound, way)})
            text = str(caught.value)
            assert text.startswith(beginning)
            low, high = text.rpartition(": must lie in [")[2].removesuffix(f"]{unit}").split(", ")
            assert (float(low), float(high)) == (field.low, field.high)

    @of_core
    @of_every_field
    def test_a_value_far_outside_is_shown_in_the_message(self, owner: Any, field: Any) -> None:
        if field.kind == "bool" or math.isinf(field.high):
            return
        value = typed(field, 2 * field.high + 1)
        with pytest.raises(ValueError) as caught:  # noqa: PT011
            owner(**{field.name: value})
        shown = str(caught.value).partition(f".{field.name} = ")[2].partition(":")[0].split()[0]
        assert float(shown) == value

    @of_core
    @of_every_field
    def test_what_is_no_number_is_refused_by_name(self, owner: Any, field: Any) -> None:
        for value in (math.nan, "2", None, [1.0]):
            with pytest.raises((ValueError, TypeError)) as caught:
                owner(**{field.name: value})
            assert f"{owner.__name__}.{field.name} = " in str(caught.value)


class ParameterContract(FieldContract):
    """What the parameters of a law promise besides."""

    @of_core
    @of_every_field
    def test_every_parameter_has_finite_bounds(self, owner: Any, field: Any) -> None:
        assert math.isfinite(field.low)
        assert math.isfinite(field.high)

    @of_core
    def test_design_refuses_what_lies_out_of_range(self, subject: Subject) -> None:
        field = next(f for f in _core(subject).fields() if f.kind != "bool")
        with pytest.raises(ValueError, match="must lie in") as caught:
            ebac.design(
                _core(subject), ebac.Device(), ebac.Timing(), **{field.name: beyond(field, field.low, -1)}
            )  # fmt: skip
        assert f"{field.name} = " in str(caught.value)

    @of_core
    def test_a_wrong_parameter_name_suggests_the_right_one(self, subject: Subject) -> None:
        cls = _core(subject)
        name = max((f.name for f in cls.fields()), key=len)
        wrong = name[:-1] + ("x" if name[-1] != "x" else "y")
        for make in (cls, lambda **p: ebac.design(cls, ebac.Device(), ebac.Timing(), **p)):
            with pytest.raises(TypeError) as caught:
                make(**{wrong: 1.0})
            assert f"no parameter '{wrong}', did you mean '{name}'" in str(caught.value)

    @of_core
    def test_parameters_are_keyword_only_and_frozen(self, subject: Subject) -> None:
        make: Any = subject.core
        with pytest.raises(TypeError):
            make(1.0)
        law: Any = subject.made()
        for field in law.fields():
            with pytest.raises(AttributeError):
                setattr(law, field.name, field.default)

    @of_core
    @inherited
    @given(data=st.data())
    def test_repr_evaluates_to_an_equal_law(self, subject: Subject, data: st.DataObject) -> None:
        cls: Any = subject.core
        values = data.draw(strategies.parameters(cls))
        timing = ebac.Timing(**data.draw(strategies.parameters(ebac.Timing)))
        law = cls(**values, timing=timing)
        assert law.as_dict() == values | {"timing": timing}
        assert eval(repr(law), {**vars(ebac), cls.__name__: cls}) == law
        for name, value in values.items():
            assert getattr(law, name) == value

    @of_core
    def test_replace_changes_one_parameter_and_checks_it(self, subject: Subject) -> None:
        law: Any = subject.made()
        field = next(f for f in law.fields() if f.kind != "bool")
        old = getattr(law, field.name)
        new = typed(field, field.high if old != field.high else field.low)
        other = law.replace(**{field.name: new})
        assert getattr(other, field.name) == new
        assert other != law
        assert other.replace(**{field.name: old}) == law
        with pytest.raises(ValueError, match=field.name):
            law.replace(**{field.name: beyond(field, field.low, -1)})

    @of_core
    def test_a_law_is_designed_from_what_is_known_of_the_device(self, subject: Subject) -> None:
        device, timing, cls = ebac.Device(), ebac.Timing(dt=5e-4, delay=2), _core(subject)
        law: Any = ebac.design(cls, device, timing)
        assert law == cls.design(device.facts, timing)
        assert law.timing == timing

    @of_core
    def test_a_law_has_a_name_a_summary_and_says_whether_it_is_passive(
        self, subject: Subject
    ) -> None:
        cls = _core(subject)
        assert cls.name
        assert cls.summary in (cls.__doc__ or "")
        assert isinstance(cls.passive, bool)


def _core(subject: Subject) -> Any:
    return subject.core
