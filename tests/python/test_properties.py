"""Hypothesis: the same examples in a clone, in CI and in every worker; others where one explores."""

from hypothesis import settings
from hypothesis.internal.conjecture import providers


def test_examples_depend_on_nothing_that_was_imported() -> None:
    found = providers._get_local_constants()
    assert not any((found.integers, found.floats, found.bytes, found.strings))


def test_only_explorations_are_random() -> None:
    assert settings.get_profile("ebac").derandomize
    assert not settings.get_profile("explore").derandomize
