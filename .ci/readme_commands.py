"""Print one of the README's two commands: `readme_commands.py 1` or `2`.

They are the first two fenced shell blocks of README.md, one line each.
What a new user reads there is what `.ci/run` runs.
"""

import re
import sys
from pathlib import Path

SHELL = {"sh", "bash", "shell", "console"}


def commands(markdown: str) -> list[str]:
    fences = re.findall(r"^```[ ]*(\w*)[^\n]*\n(.*?)^```[ ]*$", markdown, flags=re.M | re.S)
    blocks = [body.strip().splitlines() for language, body in fences if language in SHELL][:2]
    if len(blocks) < 2:
        sys.exit("README.md: two fenced shell blocks are expected")
    for number, lines in enumerate(blocks, start=1):
        if len(lines) != 1:
            sys.exit(f"README.md: shell block {number} has {len(lines)} lines, must be exactly one")
    return [lines[0].removeprefix("$ ") for lines in blocks]


if __name__ == "__main__":
    readme = Path(__file__).resolve().parents[1] / "README.md"
    print(commands(readme.read_text(encoding="utf-8"))[int(sys.argv[1]) - 1])
