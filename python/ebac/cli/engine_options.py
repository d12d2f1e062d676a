"""The options of an engine that computes the world, slower than the loop runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, TypeAlias

import typer

from ebac.cli.options import option

ENGINE = "Engine"

EngineJitter: TypeAlias = Annotated[
    float | None,
    option(
        text="Its answers come later by up to so much at random [s]", default="0.01", panel=ENGINE
    ),
]
EngineCompute: TypeAlias = Annotated[
    float | None,
    option(
        text="From a call to its answer, at least [s]", default="one period of it", panel=ENGINE
    ),
]


@dataclass(frozen=True, kw_only=True)
class EngineOptions:
    """An engine that computes the world, slower than the loop runs."""

    engine_rate: Annotated[
        float | None,
        option(
            text="Let an engine compute the world so many times a second [Hz]; the loop renders its local model",
            default="every tick",
            panel=ENGINE,
        ),
    ] = None
    engine_jitter: Annotated[
        float | None,
        option(
            text="Its answers come later by up to so much at random [s]", default="0", panel=ENGINE
        ),
    ] = None
    engine_compute: EngineCompute = None
    engine_held: Annotated[
        bool,
        typer.Option(
            "--engine-held",
            help="Hold the engine's force until its next answer, instead of rendering its local model.",
            rich_help_panel=ENGINE,
        ),
    ] = False
