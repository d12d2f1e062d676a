"""What both sides of a gastroscopy on drives share while they run and at their end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ebac._core import Fault
from ebac.gastroscope.far_side import LinkAtWork, LinkEvent, SideReport

if TYPE_CHECKING:
    from ebac.hardware import OpenDevice, Run


def silent(event: LinkEvent) -> None:
    """Report nothing."""


def agreed(device: OpenDevice) -> None:
    """Ask nobody."""


def fault_of(run: Run) -> Fault:
    """Return the fault in the newest row of a run."""
    last = run.tail(1)
    return Fault(int(last["fault"][-1])) if len(last) else Fault.NONE


def side_report(
    link: LinkAtWork, runs: Sequence[Run | None], fault: Fault, scope: dict[str, Any] | None = None
) -> SideReport:
    """Return how a side ended, from its link and its runs."""
    known = [run for run in runs if run is not None]
    reports = [run.report for run in known if run.report is not None]
    ended = [one.ended_by for one in reports if one.ended_by not in ("other drives", "time")]
    by = "fault" if fault != Fault.NONE else link.ended_by or (ended[0] if ended else "time")
    late = [run.trace()["lateness"] for run in known]
    return SideReport(
        name=link.name,
        ended_by=by,
        fault=fault,
        report=dict(link.end.report()),
        events=tuple(link.events),
        drives=tuple(state for one in reports for state in one.drives),
        logs=tuple(str(one.log) for one in reports if one.log is not None),
        skipped=sum(int(run.trace()["skipped"].sum()) for run in known),
        latest=max((float(one.max()) for one in late if len(one)), default=0.0),
        scope=scope or {},
    )
