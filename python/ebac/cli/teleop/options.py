"""Options that the commands of `ebac teleop` share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import from_options, options, output

if TYPE_CHECKING:
    from ebac._core import Link
    from ebac.scenario import Scenario

PANEL = "Network"
#: The schemes of `ebac.teleop.SCHEMES`, which help names without importing them.
NAMES = "position-force, master-passivity, two-port-passivity, waves, ebac, two-port-ebac"


@dataclass(frozen=True, kw_only=True)
class LinkOptions:
    """The network, the same both ways."""

    delay: Annotated[
        float,
        typer.Option(help="Delay in each direction [s].", min=0, max=0.5, rich_help_panel=PANEL),
    ] = 0.05
    jitter: Annotated[
        float,
        typer.Option(help="Largest additional delay [s].", min=0, max=0.2, rich_help_panel=PANEL),
    ] = 0.0
    loss: Annotated[
        float, typer.Option(help="Share of packets lost.", min=0, max=1, rich_help_panel=PANEL)
    ] = 0.0
    reorder: Annotated[
        float,
        typer.Option(
            help="Share of packets held back by 5 ms.", min=0, max=1, rich_help_panel=PANEL
        ),
    ] = 0.0
    corrupt: Annotated[
        float,
        typer.Option(help="Share of datagrams damaged.", min=0, max=1, rich_help_panel=PANEL),
    ] = 0.0
    cut_every: Annotated[
        float,
        typer.Option(
            help="Interval between cuts of the link [s]; 0 for none.", min=0, rich_help_panel=PANEL
        ),
    ] = 0.0
    cut_length: Annotated[
        float, typer.Option(help="Length of each cut [s].", min=0, rich_help_panel=PANEL)
    ] = 0.0

    def link(self) -> Link:
        """Return the link."""
        from ebac._core import Link

        if self.loss == 1 or self.corrupt == 1:
            name = "--loss" if self.loss == 1 else "--corrupt"
            output.fail(f"{name} 1: no packet would arrive; give less than 1")
        return Link(
            delay=self.delay,
            jitter=self.jitter,
            loss=self.loss,
            reorder=self.reorder,
            corrupt=self.corrupt,
            cut_every=self.cut_every,
            cut_length=self.cut_length,
        )


@dataclass(frozen=True, kw_only=True)
class MasterOptions(options.DeviceOptions):
    """The stick of the master, and whether it has the state observer."""

    observer: Annotated[bool | None, options.observer()] = None
    scenario: options.ScenarioFile = None

    def stick(self) -> Scenario:
        """Return a scenario with the device and the timing of the master."""
        return from_options.scenario(self)
