"""Law, stiffness and world changed in contact: the new contact stands, and no account starves."""

from pathlib import Path

import numpy as np
import pytest

from ebac.live.session import Session

CHANGES = [
    *({"law": law} for law in ("direct", "tca", "tca-damped", "eba", "passivity-control")),
    {"stiffness": 2e3},
    {"law": "tca", "stiffness": 3.5e4},
]


@pytest.mark.parametrize("before", CHANGES, ids=lambda one: ",".join(map(str, one.values())))
@pytest.mark.parametrize("observer", [True, False])
@pytest.mark.slow
def test_ebac_that_takes_over_in_contact_rests_where_it_would_have(
    tmp_path: Path, before: dict[str, object], observer: bool
) -> None:
    wanted = {"law": "ebac", "stiffness": 2e4}

    def rest(*changes: dict[str, object]) -> tuple[float, float]:
        with Session(virtual=True, paced=False, folder=tmp_path) as session:
            session.change(observer=observer, **changes[0])
            session.start()
            session.advance(1.0)
            for change in changes[1:]:
                assert not session.change(**change)
            session.advance(4.0)
            assert session.fault == 0
            x = session.run.tail(300)["x"][:, 0]  # type: ignore[union-attr]
            return float(x.mean()), float(np.ptp(x))

    place, swing = rest(before, wanted)
    assert abs(place - rest(wanted)[0]) < 6e-5
    assert swing < 2.5e-4


def test_a_world_around_the_handle_brings_it_out(tmp_path: Path) -> None:
    with Session(virtual=True, paced=False, folder=tmp_path) as session:
        session.change(world="free")
        session.start()
        session.advance(1.0)
        assert not session.change(world="wall")
        session.advance(8.0)
        assert session.fault == 0
        x = session.run.tail(100)["x"][:, 0]  # type: ignore[union-attr]
        assert abs(float(x.mean()) - 10.9e-3) < 3e-4
