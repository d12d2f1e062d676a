"""The pytest plugin of ebac: golden traces by the fixture `ebac_trace`, rewritten with `--ebac-update`.

It stands beside the package and not inside it: pytest imports every plugin in every project, and this one then costs
neither NumPy nor the core. What it needs is imported when a test asks for it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from ebac.testing.golden import TraceRegression

#: So that a promise of a law that does not hold shows its numbers.
pytest.register_assert_rewrite("ebac.testing.contract")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the flag and the setting."""
    group = parser.getgroup("ebac", "ebac: golden traces")
    group.addoption(
        "--ebac-update",
        action="store_true",
        help="write golden traces and their metrics anew instead of comparing with them",
    )
    parser.addini(
        "ebac_golden",
        "folder of the golden traces, from the root of the project; "
        "default: a folder beside each test file, with its name",
    )


@pytest.fixture
def ebac_trace(request: pytest.FixtureRequest) -> TraceRegression:
    """Compare traces with golden ones: `ebac_trace.check(trace)`.

    The first run writes the golden trace and fails; look at it and commit it. A difference names the first
    divergence, the channel and the largest error, and an overlay is drawn into the folder of the test.
    """
    from ebac.testing.golden import TraceRegression

    return TraceRegression.of(request)
