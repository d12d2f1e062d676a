"""What of the pages a test does not run, or not always, and why: the only place that says so.

A rule is found by a pattern in the command or block of Python. The first that fits decides; what has no rule is run.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

#: What is done with a command: never run; run only with EBAC_ALL_COMMANDS=1; run beside all that follows until Ctrl-C;
#: run, and it must end with an error.
NEVER, SLOW, BESIDE, FAILS = "never", "slow", "beside", "fails"


@dataclass(frozen=True)
class Rule:
    """What is done with a command, and why."""

    pattern: str
    action: str
    why: str


RULES = (
    # What changes the machine, or needs what a test does not have.
    Rule(r"^sudo |^apt ", NEVER, "needs root"),
    Rule(
        r"^git clone|pip install|pip download|^pipx? ",
        NEVER,
        "needs the network; .ci/run installs as README says",
    ),
    Rule(
        r"^\.venv/bin/pytest|^pytest\b", NEVER, "is this test run; .ci/run does it as README says"
    ),
    Rule(r"^cmake |^ctest ", NEVER, "builds C++; .ci/run builds and tests the same example"),
    Rule(
        r"^jupy\w+ ",
        NEVER,
        "a test of its own opens every notebook, the building of the site executes it",
    ),
    Rule(r"docs/figures/", NEVER, "takes minutes, and needs a clone"),
    Rule(
        r"\bv?can\d\b|=socketcan|--interface socketcan",
        NEVER,
        "needs a CAN interface; .ci/socketcan tests it",
    ),
    Rule(r"logs\.Recorder\(rows", NEVER, "needs a running loop; tests of the recorder have one"),
    Rule(r"^ebac drive restore", NEVER, "needs the backup of a device"),
    Rule(r"192\.168\.", NEVER, "needs a force sensor"),
    Rule(r"\bmy-[a-z]+\.toml", NEVER, "needs a file of the reader's own"),
    Rule(r"^ebac run .*--law tca\b", NEVER, "shakes; a loaded machine or a limit may end it"),
    # What runs until Ctrl-C: the steps that follow meet it.
    Rule(r"^ebac (drive|sensor) simulate", BESIDE, "runs until Ctrl-C"),
    Rule(r"^ebac sensor read(?!.*--seconds)", BESIDE, "runs until Ctrl-C"),
    Rule(r"^python -m can\.logger", BESIDE, "runs until Ctrl-C"),
    Rule(r"^ebac drive verify --interface ebac", FAILS, "new simulated drives hold no profile"),
    # What takes minutes.
    Rule(r"^ebac paper( all)?( --out \S+)?$", NEVER, "takes minutes; tests run its items"),
    Rule(r"^ebac bench", NEVER, "takes a minute; tests run it with small numbers"),
    Rule(r"^ebac tune [\w,-]+( --json.*)?$", NEVER, "takes minutes; tests search with few hands"),
    Rule(r"^ebac identify check", NEVER, "takes a minute; tests run it with few logs"),
    Rule(
        r"^ebac study.* (cells|five|robustness|failures|all|hands|damped-walls)\b",
        NEVER,
        "takes a minute; tests run the conditions",
    ),
    Rule(
        r"--hands [1-9]\d{2,}|--evaluations \d{5}|--cases \d{5}|--runs \d{3}",
        NEVER,
        "takes a minute",
    ),
    Rule(
        r"^ebac zwidth$|^ebac map$|^ebac worst( --change \S+)?$|^ebac faults$",
        NEVER,
        "takes half a minute",
    ),
    # What takes more than some seconds of one core.
    Rule(
        r"^ebac (study|ablation|tune|worst|zwidth|map|faults|paper|jitter|doctor|run)\b",
        SLOW,
        "takes seconds",
    ),
    Rule(
        r"^ebac wall.*(--law all|--format)|^ebac identify gains|^ebac track --simulated|--through can",
        SLOW,
        "takes seconds",
    ),
)


def rule(command: str) -> Rule | None:
    """Return the rule for a command, None for one that is always run."""
    return next((known for known in RULES if re.search(known.pattern, command)), None)
