"""`ebac bus load`: what the process data of a device take of a CAN bus."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import output
from ebac.cli.command import Group, add

if TYPE_CHECKING:
    from ebac._core import BusLoad

#: Two frames of 8 bytes a tick: three forces and three torques of 16 bits and a status.
SENSOR_FRAMES, SENSOR_BYTES, SENSOR_ID = 2, 8, 0x1F0

bus = typer.Typer(cls=Group, no_args_is_help=True, help="Compute the load of a CAN bus.")


def load(
    nodes: Annotated[int, typer.Option(help="Drives on the bus.", min=1, max=127)] = 2,
    rate: Annotated[float, typer.Option(help="Ticks per second, one SYNC each [Hz].")] = 1000,
    bitrate: Annotated[float, typer.Option(help="Bit rate of the bus [bit/s].")] = 1e6,
    force_sensor: Annotated[
        bool,
        typer.Option(
            "--force-sensor",
            help="Include a force sensor that sends on the same bus in every tick.",
        ),
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Compute the worst-case load of a CAN bus from the frames of each tick.

    Each tick sends one SYNC, and for every drive controlword and target torque; every drive answers with statusword,
    position and actual torque. The worst case has the largest possible number of stuff bits. A load above 70 % gives
    a warning, above 90 % exit code 2.

    **Examples**

    * `ebac bus load`: two drives at 1 kHz and 1 Mbit/s take 52 %

    * `ebac bus load --nodes 3 --rate 500 --json`: as JSON
    """
    with output.refusing():
        plan, warning, refused = _judge(_plan(nodes, rate, bitrate, force_sensor))
    if as_json:
        typer.echo(_document(plan, warning or refused))
    else:
        _show(plan)
        if warning:
            output.say(f"Warning: {warning}.", style="yellow")
    if refused:
        output.fail(refused)


add(bus, load)


def _plan(nodes: int, rate: float, bitrate: float, force_sensor: bool) -> BusLoad:
    from ebac._core import BusLoad, PlannedFrame, pdo_plan

    if not 0.1 <= rate <= 1e5:
        raise ValueError(f"--rate = {rate:g} Hz: must lie in [0.1, 100000] Hz")
    if not 1e4 <= bitrate <= 1e6:
        raise ValueError(f"--bitrate = {bitrate:g} bit/s: must lie in [10000, 1000000] bit/s")
    frames = pdo_plan(list(range(1, nodes + 1)))
    if force_sensor:
        frames.append(
            PlannedFrame(what="force sensor", id=SENSOR_ID, size=SENSOR_BYTES, count=SENSOR_FRAMES)
        )
    return BusLoad(frames=frames, bit_rate=bitrate, period=1 / rate)


def _judge(plan: BusLoad) -> tuple[BusLoad, str, str]:
    """Return the plan, what to be warned of, and why it is refused; empty where neither is."""
    try:
        return plan, plan.check(), ""
    except ValueError as error:
        return plan, "", str(error)


def _document(plan: BusLoad, remark: str) -> str:
    rows: list[dict[str, Any]] = [
        {
            "what": frame.what,
            "cob_id": frame.id,
            "size_bytes": frame.size,
            "frames": frame.count,
            "bits": plan.bits(frame),
            "share": plan.frame_share(frame),
        }
        for frame in plan.frames
    ]
    return output.document(
        "bus load",
        rows,
        bit_rate_bit_per_s=plan.bit_rate,
        period_s=plan.period,
        busy_s=plan.seconds,
        share=plan.share,
        highest_rate_Hz=plan.highest_rate,
        remark=remark or None,
    )


def _show(plan: BusLoad) -> None:
    grid = output.table(["frame", "COB-ID", "bytes", "bits", "time", "share"], numbers=range(1, 6))
    for frame in plan.frames:
        times = f"{frame.count} x " if frame.count > 1 else ""
        bits = plan.bits(frame)
        grid.add_row(
            frame.what,
            f"0x{frame.id:03X}",
            f"{times}{frame.size}",
            f"{bits}",
            f"{1e6 * bits / plan.bit_rate:.0f} us",
            f"{100 * plan.frame_share(frame):.1f} %",
        )
    grid.add_section()
    busy = f"{1e6 * plan.seconds:.0f} us"
    grid.add_row(
        "all", "", "", f"{sum(map(plan.bits, plan.frames))}", busy, f"{100 * plan.share:.1f} %"
    )
    output.show(grid)
    output.say(
        f"At the worst, of each {1e6 * plan.period:.6g} us on a bus at {plan.bit_rate / 1e3:g} "
        f"kbit/s; these frames fit up to {int(plan.highest_rate)} Hz."
    )
