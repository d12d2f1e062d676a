"""The report of a run in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac._util.plural import plural

if TYPE_CHECKING:
    from ebac._core import Grant
    from ebac.hardware.report import Report


def one_line(report: Report) -> str:
    """Return how a run ended and what it left, in one line."""
    kept = "no log" if report.log is None else f"{plural(report.recorded, 'row')} in {report.log}"
    lost = f", {report.lost_rows} lost" if report.lost_rows else ""
    refused = [grant.name for grant in report.grants if not grant.granted]
    denied = f"; not granted: {', '.join(refused)}" if refused else ""
    return f"<Report: {plural(report.ticks, 'tick')}, ended by {report.ended_by}; {kept}{lost}{denied}>"


def listed(report: Report) -> str:
    """Return every part of a report, one a line."""
    lines = [
        ("log", "none" if report.log is None else str(report.log)),
        ("rows", f"{report.recorded:,} recorded, {report.lost_rows:,} lost"),
        ("updates", f"{report.changes_lost:,} not recorded"),
        *(("position", str(one)) for one in report.positions),
        *(("drive", state) for state in report.drives),
        ("frames", _frames(report)),
        *(("grant", granted(one)) for one in report.grants),
    ]
    title = f"Run of {plural(report.ticks, 'tick')}, ended by {report.ended_by}"
    return "\n".join([title, *(f"  {name:<10}{text}" for name, text in lines)])


def _frames(report: Report) -> str:
    counts = {
        "sent": report.sent,
        "received": report.received,
        "refused": report.refused,
        "lost": report.lost_frames,
    }
    return ", ".join(f"{count:,} {what}" for what, count in counts.items())


def granted(grant: Grant) -> str:
    """Return what was asked of the system, and whether it was granted: "priority: SCHED_FIFO 80, granted"."""
    answer = "granted" if grant.granted else f"not granted ({grant.why}); {grant.remedy}"
    return f"{grant.name}: {grant.asked}, {answer}"
