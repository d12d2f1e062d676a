"""What of the pages a test does not run, or not always, and why: the only place that says so.

A rule is found by a pattern in the command or block of Python. The first that fits decides; what has no rule is run.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import reduce

#: What is done with a command: never run; run only with EBAC_ALL_COMMANDS=1; run beside all that follows until Ctrl-C;
#: run, and it must end with an error; run always, but shorter.
NEVER, SLOW, BESIDE, FAILS, SHORT = "never", "slow", "beside", "fails", "short"


@dataclass(frozen=True)
class Rule:
    """What is done with a command, and why; `fewer` are options it is run with, for fewer runs of the same kind."""

    pattern: str
    action: str
    why: str
    fewer: str = ""


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
    Rule(
        r"^build/|ENGINE",
        NEVER,
        "needs a build; .ci/chai3d runs it where there is a CHAI3D",
    ),
    Rule(r"^cmake |^ctest ", NEVER, "builds C++; .ci/run builds and tests the same example"),
    Rule(
        r"^jupy\w+ ",
        NEVER,
        "a test of its own opens every notebook, the building of the site executes it",
    ),
    Rule(r"docs/figures/|tests/recordings/", NEVER, "takes minutes, and needs a clone"),
    Rule(
        r"\bv?can\d\b|=socketcan|--interface socketcan",
        NEVER,
        "needs a CAN interface; .ci/socketcan tests it",
    ),
    Rule(r"logs\.Recorder\(rows", NEVER, "needs a running loop; tests of the recorder have one"),
    Rule(
        r"^python bindings/wasm|ebac live --page|ebac\.live\.widget",
        NEVER,
        "needs the core as WebAssembly; test_live.py has it",
    ),
    Rule(r"^ssh ", NEVER, "needs another machine"),
    Rule(r"^ebac gastroscopy --live", NEVER, "opens a browser; test_gastroscopy_browser.py"),
    Rule(r"^ebac live", NEVER, "opens a browser; test_live_server.py starts it without one"),
    Rule(r"^ebac drive restore", NEVER, "needs the backup of a device"),
    Rule(r"192\.168\.", NEVER, "needs a force sensor"),
    Rule(r"\bmy-[a-z]+\.toml", NEVER, "needs a file of the reader's own"),
    Rule(
        r"\bmine\.py:|\bmy_laws:",
        NEVER,
        "needs a law of the reader's own; test_cli_own_law.py has one",
    ),
    Rule(r"^ebac run .*--law tca\b", NEVER, "shakes; a loaded machine or a limit may end it"),
    # What runs until Ctrl-C: the steps that follow meet it.
    Rule(r"^ebac (drive|sensor) simulate", BESIDE, "runs until Ctrl-C"),
    Rule(r"^ebac teleop (master|network|slave)(?!.*--seconds)", BESIDE, "runs until Ctrl-C"),
    Rule(r"^ebac gastroscopy (master|slave).*my-", NEVER, "needs drives"),
    Rule(r"^ebac gastroscopy (master|slave)(?!.*--seconds)", BESIDE, "runs until Ctrl-C"),
    Rule(r"^ebac log info slave\.mcap", SLOW, "reads what a command that takes seconds writes"),
    Rule(
        r"^ebac gastroscopy drives --seconds 10$", NEVER, "the example with a bad network does it"
    ),
    Rule(r"^ebac gastroscopy drives", SLOW, "takes seconds", fewer="--seconds 1"),
    Rule(r"^ebac teleop study", SLOW, "takes seconds", fewer="--scheme waves --delay 0.05"),
    Rule(r"^ebac teleop endurance$", NEVER, "takes minutes; the example with options is run"),
    Rule(r"^ebac teleop endurance", SLOW, "takes minutes", fewer="--seconds 5"),
    Rule(r"^ebac teleop master.*--seconds", SLOW, "takes its time", fewer="--seconds 2"),
    Rule(r"^ebac sensor read(?!.*--seconds)", BESIDE, "runs until Ctrl-C"),
    Rule(r"^python -m can\.logger", BESIDE, "runs until Ctrl-C"),
    Rule(r"^ebac drive verify --interface ebac", FAILS, "new simulated drives hold no profile"),
    # What takes minutes.
    Rule(r"^ebac paper( all)?( --out \S+)?$", NEVER, "takes minutes; tests run its items"),
    Rule(r"^ebac bench", NEVER, "takes a minute; tests run it with small numbers"),
    Rule(r"^ebac tune(?!.*--evaluations)", NEVER, "takes minutes; tests search with few hands"),
    Rule(r"^ebac identify check", NEVER, "takes a minute; tests run it with few logs"),
    Rule(
        r"^ebac study.* (cells|five|robustness|failures|all|hands|damped-walls)\b",
        NEVER,
        "takes a minute; tests run the conditions",
    ),
    Rule(r"\bhold-1h\b", NEVER, "takes half a minute; `hold` is run"),
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
    # What takes more than some seconds of one core: with fewer hands, points or cases it does all that a page shows.
    Rule(
        r"^ebac ablation( --device-noise \S+| --no-observer)*$",
        NEVER,
        "takes 2 s of a core even with one hand; those with more options are run",
    ),
    Rule(
        r"^ebac ablation --scenario",
        NEVER,
        "takes 10 s of a core even with one hand; its options are those of the ones that are run",
    ),
    Rule(
        r"^ebac ablation --change pull=40 ",
        NEVER,
        "takes 3 s of a core even with one hand; the one of the story has more changes",
    ),
    Rule(
        r"^ebac stiffest\b",
        SLOW,
        "takes a minute",
        fewer="--population random --hands 1 --wall-stiffness 2000",
    ),
    Rule(r"^ebac (study|ablation)\b", SLOW, "takes seconds", fewer="--population random --hands 1"),
    Rule(
        r"^ebac tune all\b",
        SLOW,
        "takes minutes",
        fewer="--hands 3 --evaluations 4 -c d1K10",
    ),
    Rule(r"^ebac tune\b", SLOW, "takes seconds", fewer="--hands 3 --evaluations 4"),
    Rule(
        r"^ebac worst (?=.*--device-noise)(?!.*--family)",
        SLOW,
        "takes seconds; the help's examples search every family",
        fewer="--evaluations 40 --family swinging",
    ),
    Rule(r"^ebac worst\b", SLOW, "takes seconds", fewer="--evaluations 40"),
    Rule(
        r"^ebac zwidth\b(?!.*--law)",
        SLOW,
        "takes seconds",
        fewer="--points 2 --seconds 1 --law ebac --law tca",
    ),
    Rule(
        r"^ebac zwidth\b.*tca-damped-tuned-observer.*--hands \d",
        NEVER,
        "takes minutes; the one of ebac has its options",
    ),
    Rule(
        r"^ebac zwidth\b.*--hands \d",
        SLOW,
        "takes minutes",
        fewer="--points 2 --seconds 1 --delay 1 --hands 1",
    ),
    Rule(r"^ebac zwidth\b", SLOW, "takes seconds", fewer="--points 2 --seconds 1"),
    Rule(r"^ebac gastroscopy study\b", SLOW, "takes minutes", fewer="--physicians 2 --seconds 2"),
    Rule(r"^ebac gastroscopy (master|slave)", SLOW, "takes its time", fewer="--seconds 1"),
    Rule(r"^ebac gastroscopy\b", SLOW, "takes seconds", fewer="--seconds 2"),
    Rule(
        r"^ebac shapes$",
        SLOW,
        "takes half a minute",
        fewer="--law ebac --device joystick --world sphere,texture",
    ),
    Rule(r"^ebac shapes\b", SLOW, "takes half a minute", fewer="--law ebac --device joystick"),
    Rule(r"^ebac random-worlds\b", SLOW, "takes seconds", fewer="--hands 2"),
    Rule(r"^ebac map\b", SLOW, "takes seconds", fewer="--side 8"),
    Rule(r"^ebac faults\b", SLOW, "takes seconds", fewer="--cases 5"),
    Rule(r"^ebac track --simulated", SLOW, "takes seconds", fewer="--runs 4"),
    Rule(r"^ebac jitter\b", SLOW, "takes seconds", fewer="--seconds 1"),
    Rule(r"^ebac run\b(?!.*--at)", SLOW, "takes its time", fewer="--seconds 1.5"),
    Rule(r'^ebac run\b.*--at "6 ', NEVER, "takes its time; one that changes earlier is run"),
    Rule(r'^ebac run\b.*--at "2.5 ', SLOW, "takes its time", fewer="--seconds 3"),
    Rule(r"^ebac (paper|doctor|run)\b", SLOW, "takes seconds"),
    Rule(
        r"^ebac wall.*(--law all|--format)|--through can",
        SLOW,
        "takes seconds",
        fewer="--seconds 1",
    ),
    # Its log is cut from 1 to 2 s.
    Rule(r"^ebac wall\b.*--log ", SHORT, "writes and draws what it simulates", "--seconds 2.5"),
    Rule(r"^ebac wall\b", SHORT, "writes and draws what it simulates", "--seconds 1"),
    Rule(
        r"^ebac identify gains.*(--out|--law)",
        NEVER,
        "takes 2 s of a core; test_identify_gains.py runs it so, and without them it is run here",
    ),
    Rule(r"^ebac identify gains", SLOW, "takes seconds"),
)
#: What is run instead: three hands of the 60; one second of the gastroscope's three processes; twenty hands of a
#: thousand; a quarter of the hills, fewer points on the way, coarser grids; one of the walls that are held for 120 s.
FEWER = (
    ("Operators.grid()", "Operators.grid()[::20]"),
    ("chain(3,", "chain(1,"),
    ("range(1000)", "range(20)"),
    ("np.linspace(-0.04, 0.04, 41)", "np.linspace(-0.02, 0.02, 21)"),
    ("2 * np.pi, 5000)", "2 * np.pi, 500)"),
    ("(None, 0.4e-3)", "(2e-3, 1e-3)"),
    ("-c holds ", "-c hold-K20 "),
)
#: What draws is run without files, which are most of its time: the building of the site draws every kind of figure by
#: its command, and tests of the commands look at their files. With files: what has no options, or options for files.
DRAWS = (
    r"^ebac (ablation|map|random-worlds|shapes|stiffest|study|wall|worst|zwidth) "
    r"(?!.*--(format|json|log|no-files|out|resume|width)\b)"
)


def rule(command: str) -> Rule | None:
    """Return the rule for a command, None for one that is always run."""
    return next((known for known in RULES if re.search(known.pattern, command)), None)


def as_run(command: str) -> str:
    """Return a command as a test runs it."""
    known = rule(command)
    command = reduce(lambda text, words: text.replace(*words), FEWER, command)
    more = known.fewer if known else ""
    if re.search(DRAWS, command, re.S):
        more += " --no-files"
    if not more:
        return command
    words, rest = re.fullmatch(r"([^|&;<>]*)(.*)", command, re.S).groups()  # type: ignore[union-attr]
    return f"{words.rstrip()} {more.strip()} {rest}".rstrip()
