"""What fails on the way out is neither lost nor hides what failed first."""

import pytest

from ebac._util.exception_notes import noted_on


def fail_twice() -> None:
    try:
        raise KeyError("first")
    except KeyError as error:
        with noted_on(error, "and the lamp stayed on"):
            raise OSError("no switch") from None
        raise


def test_what_failed_first_is_raised_and_carries_the_second() -> None:
    with pytest.raises(KeyError, match="first") as caught:
        fail_twice()
    assert caught.value.__notes__ == ["and the lamp stayed on: no switch"]


def test_alone_it_is_raised_itself() -> None:
    with pytest.raises(OSError, match="no switch"), noted_on(None, "and the lamp stayed on"):
        raise OSError("no switch")


def test_an_interrupt_is_not_noted_away() -> None:
    error = KeyError("first")
    with pytest.raises(KeyboardInterrupt), noted_on(error, "and the lamp stayed on"):
        raise KeyboardInterrupt
    assert not hasattr(error, "__notes__")
