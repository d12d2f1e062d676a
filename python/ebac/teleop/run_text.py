"""A run of teleoperation in words: its network, contact, hand and device, and its results."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac._util import descriptions, formatting

if TYPE_CHECKING:
    from ebac._core import Link, SlaveModel
    from ebac.teleop.run import Run

#: What a printed run shows: label, attribute, unit, what to print where there is none.
LINES = (
    ("swing, peak to peak", "swing_m", "m", "-"),
    ("least, master", "least_master_J", "J", "-"),
    ("least, both ports", "least_network_J", "J", "-"),
    ("transparency", "transparency", "1", "-"),
    ("drift", "drift_m", "m", "-"),
    ("contact, at rest", "rest_N", "N", "-"),
    ("contact, at most", "most_N", "N", "-"),
)
#: What a run is called by the passivity of the master's port and of both ports together.
PASSIVE = {
    (True, True): "passive at the master's port and at both ports together",
    (True, False): "passive at the master's port, not at both ports together",
    (False, True): "passive at both ports together, not at the master's port",
    (False, False): "not passive",
}
#: What the packets of a side are called.
COUNTED = ("received", "missing", "late", "doubled", "foreign")


def conditions(run: Run) -> tuple[str, ...]:
    """Return law, network, contact, hand and device of a run, each in words."""
    there, back = _link(run.there), _link(run.back)
    network = f"each way {there}" if there == back else f"there {there}; back {back}"
    return (
        f"law {run.law}",
        network,
        _contact(run.slave),
        descriptions.described_hand(run.scenario.hand),
        descriptions.described_device(run.scenario.device),
        descriptions.described_time(run.scenario),
    )


def _link(link: Link) -> str:
    """Return the delay and the faults of one direction: "50 ms of delay, 10 % lost"."""
    parts = [f"{1e3 * link.delay:g} ms of delay"]
    if link.jitter:
        parts.append(f"up to {1e3 * link.jitter:g} ms of jitter")
    for share, what in (
        (link.loss, "lost"),
        (link.reorder, "out of order"),
        (link.corrupt, "damaged"),
    ):
        if share:
            parts.append(f"{100 * share:g} % {what}")
    if link.cut_every and link.cut_length:
        parts.append(f"cut for {link.cut_length:g} s every {link.cut_every:g} s")
    return ", ".join(parts)


def _contact(slave: SlaveModel) -> str:
    if not slave.contact_stiffness:
        return "free motion"
    return f"contact of {slave.contact_stiffness:g} N/m at {1e3 * slave.contact:g} mm"


def verdict(run: Run) -> str:
    """Return what a run came to: "still, passive at the master's port, not at both ports together".

    A stick that is not still "swings", or is "still moving" where the run ended before its motion did.
    """
    return f"{_moves(run)}, {PASSIVE[run.passive, run.two_port_passive]}"


def _moves(run: Run) -> str:
    if run.still:
        return "still"
    if not run.whole:
        return "ended early"
    return "still moving" if run.still_moving else "swings"


def one_line(run: Run) -> str:
    """Return the verdict and the main numbers in one line."""
    numbers = [
        f"{label} {formatting.quantity(getattr(run, name), unit)}"
        for label, name, unit, _ in (LINES[0], LINES[3], LINES[5])
    ]
    return f"<Run of {run.scheme.name}: {verdict(run)}; {', '.join(numbers)}>"


def listed(run: Run) -> str:
    """Return the verdict, the conditions and every number with its unit, one a line."""
    title = "\n".join(
        (
            f"Teleoperation under {run.scheme.name}, simulated: {verdict(run)}",
            *(f"  {one}" for one in conditions(run)),
        )
    )
    packets = [
        f"  {f'packets at {side}':<20}" + ", ".join(f"{counts[name]} {name}" for name in COUNTED)
        for side, counts in (("master", run.at_master), ("slave", run.at_slave))
    ]
    return "\n".join((formatting.listed(title, run, LINES), *packets))
