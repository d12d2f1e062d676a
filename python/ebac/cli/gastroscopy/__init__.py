"""`ebac gastroscopy`: a navigation, the study of feedback, and the same on drives."""

from __future__ import annotations

from typing import Any

import typer

from ebac.cli import by_option, interrupts
from ebac.cli.command import Group, add, expanded
from ebac.cli.gastroscopy import chain, drives, navigate, study


class OwnAndStudy(Group):
    """A command of its own that has another below it."""

    def invoke(self, ctx: Any) -> Any:
        """Run the navigation, or the study."""
        by_option.begin(ctx)
        with interrupts.interruptible():
            return super().invoke(ctx)


app = typer.Typer(name="gastroscopy", cls=OwnAndStudy)
app.callback(invoke_without_command=True)(expanded(navigate.gastroscopy, "gastroscopy"))
add(app, study.study)
add(app, chain.drives)
add(app, drives.master)
add(app, drives.slave)
