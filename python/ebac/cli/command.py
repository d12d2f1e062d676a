"""What every command is: options in groups, wrong input, Ctrl-C."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from copy import copy
from dataclasses import fields, is_dataclass
from typing import Any, get_type_hints

import typer
from typer.core import TyperCommand, TyperGroup

from ebac._util.arguments import did_you_mean
from ebac._util.remarks import silent
from ebac.cli import by_option, files, interrupts, options, output, wrong_input

#: Panels of the options of a scenario.
SCENARIO = (options.WALL, options.HAND, options.DEVICE, options.RUN)
_UsageError: Any = typer.BadParameter.__mro__[1]

#: A group of no more commands lists them where a word is none.
FEW = 15
#: Commands by words that people use for them, which look like others: by group, `ebac` for the program itself.
MEANT = {("teleop", "simulate"): "run", ("ebac", "simulate"): "wall"}


class Command(TyperCommand):
    """A command that refuses in one sentence, and ends well on Ctrl-C."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the words after the command."""
        words = _numbers_apart(args, self)
        try:
            rest: list[str] = super().parse_args(ctx, list(words))
        except _UsageError as error:
            if ctx.resilient_parsing or type(error).__name__ == "NoArgsIsHelpError":
                raise
            output.fail(wrong_input.sentence(error, self, words))
        wrong = wrong_input.not_finite(self, ctx.params)
        if wrong and not ctx.resilient_parsing:
            output.fail(wrong)
        return rest

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help."""
        with one_column(self.params):
            super().format_help(ctx, formatter)

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        by_option.begin(ctx)
        with files.claims(), interrupts.interruptible(), silent(), _faults_in_one_line():
            return super().invoke(ctx)


@contextmanager
def _faults_in_one_line() -> Iterator[None]:
    """End a command in one sentence when a run stopped on a fault, or a law of the user's own raised an error."""
    try:
        yield
    except (typer.Exit, typer.Abort, _UsageError):
        raise
    except Exception as error:
        from ebac.cli.own_law import raised_by_own
        from ebac.simulation import LoopFault

        if not isinstance(error, LoopFault):
            if own := raised_by_own(error):
                output.fail(own, code=output.FAILED)
            raise
        said = str(error).partition("; see .trace")[0]
        law = f"{error.trace.law}: " if error.trace.law else ""
        output.fail("; ".join(filter(None, [f"{law}{said}", error.remedy])), code=output.FAILED)


class Group(TyperGroup):
    """A command of commands that refuses in one sentence."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the words up to the command."""
        try:
            rest: list[str] = super().parse_args(ctx, list(args))
        except _UsageError as error:
            if ctx.resilient_parsing or type(error).__name__ == "NoArgsIsHelpError":
                raise
            output.fail(wrong_input.sentence(error, self, args))
        return rest

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the command by its name."""
        try:
            return super().resolve_command(ctx, args)
        except _UsageError:
            if ctx.resilient_parsing:
                raise
            known = [name for name, one in self.commands.items() if not one.hidden]
            path = ctx.command_path
            meant = MEANT.get((path.split()[-1], args[0]), "")
            near = did_you_mean(args[0], known, [meant])
            if not near and len(known) <= FEW:
                near = f", there {'is' if len(known) == 1 else 'are'} {', '.join(known)}"
            output.fail(f"{path} {args[0]}: there is no such command{near}; see {path} --help")


@contextmanager
def one_column(params: Sequence[Any]) -> Iterator[None]:
    """Show the two names of a switch below each other: side by side they leave 80 columns no room for names."""
    names = [(one, list(one.opts), list(one.secondary_opts)) for one in params]
    for one, first, second in names:
        if second:
            one.opts, one.secondary_opts = ["\n".join([*first, *second])], []
    try:
        yield
    finally:
        for one, first, second in names:
            one.opts, one.secondary_opts = first, second


def _numbers_apart(words: Sequence[str], command: Any) -> list[str]:
    """Write `--option 1,2` as `--option 1 --option 2`, where an option takes several numbers."""
    several = [p for p in command.params if getattr(p, "multiple", False)]
    names = {name for p in several if wrong_input.is_number(p) for name in p.opts}
    apart: list[str] = []
    for word in words:
        name, equals, value = word.partition("=")
        if equals and name in names:
            apart += [f"{name}={one}" for one in value.split(",")]
        elif apart and apart[-1] in names:
            first, *more = word.split(",")
            apart += [first, *(part for one in more for part in (apart[-1], one))]
        else:
            apart.append(word)
    return apart


def add(
    app: typer.Typer,
    function: Callable[..., None],
    name: str | None = None,
    *,
    panel: str | None = None,
    defaults: str | None = None,
) -> None:
    """Make a function a command of `app`; a parameter that is a group of options becomes its options.

    Parameters
    ----------
    app : typer.Typer
        What the command belongs to.
    function : callable
        The command; its docstring is the help.
    name : str, optional
        Name of the command; default: that of the function.
    panel : str, optional
        Panel of the help of `app` it stands in.
    defaults : str, optional
        What the help says is the default of the options of a scenario, where it is not that of the reference scenario.
    """
    called = name or function.__name__.replace("_", "-")
    grouped = isinstance(app.info.name, str) and app.info.name != "ebac"
    whole = expanded(function, f"{app.info.name}-{called}" if grouped else called, defaults)
    app.command(called, cls=Command, rich_help_panel=panel)(whole)


def expanded(
    function: Callable[..., None], name: str = "", defaults: str | None = None
) -> Callable[..., None]:
    """Return the function with the fields of its groups of options, dataclasses, as its parameters."""
    hints = get_type_hints(function, include_extras=True)
    groups: dict[str, Any] = {
        key: kind for key, kind in hints.items() if isinstance(kind, type) and is_dataclass(kind)
    }
    parameters = []
    for parameter in inspect.signature(function).parameters.values():
        kind = hints[parameter.name]
        if parameter.name not in groups:
            parameters.append(parameter.replace(kind=parameter.KEYWORD_ONLY, annotation=kind))
            continue
        known = get_type_hints(kind, include_extras=True)
        parameters += [
            inspect.Parameter(
                field.name,
                inspect.Parameter.KEYWORD_ONLY,
                default=field.default,
                annotation=_option(known[field.name], name, defaults),
            )
            for field in fields(kind)
        ]

    def run(**given: Any) -> None:
        built = {
            key: kind(**{field.name: given.pop(field.name) for field in fields(kind)})
            for key, kind in groups.items()
        }
        function(**given, **built)

    run.__name__, run.__doc__ = function.__name__, function.__doc__
    run.__module__ = function.__module__
    run.__annotations__ = {p.name: p.annotation for p in parameters} | {"return": None}
    run.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return run


def _option(annotation: Any, name: str, defaults: str | None) -> Any:
    """Return the annotation of an option with the command's own default in its help."""
    info = copy(annotation.__metadata__[0])
    if isinstance(info.show_default, str):
        info.show_default = info.show_default.replace("COMMAND", name)
        if defaults is not None and info.rich_help_panel in SCENARIO:
            info.show_default = defaults
    from typing import Annotated

    return Annotated[annotation.__origin__, info]
