"""Help texts that name what a command does by default."""

from typer.testing import CliRunner

from ebac.cli import app
from ebac.cli.wall.wall import DEFAULT_LAWS


def helped(*words: str) -> str:
    text = CliRunner().invoke(app, [*words, "--help"]).output
    return " ".join(text.replace("│", " ").split())


def test_the_help_names_the_laws_that_wall_runs() -> None:
    assert f"default: ({', '.join(DEFAULT_LAWS)})" in helped("wall")
    assert len(DEFAULT_LAWS) == 4
    assert "under four laws" in helped()
