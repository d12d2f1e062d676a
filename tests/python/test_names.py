"""Names of the Python package are terms of the field, and no paragraph of the pages is a wall of text."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "python" / "ebac"
#: Words of a paragraph or of an item of a list, at most: a longer one is read by nobody.
LONGEST = 150
#: Words of the house dialect, as words of their own; words of the field that contain them are meant otherwise.
WORDS = re.compile(
    r"\b(heard|felt|aimed|foretell\w*|foretold|doorbell|at the desk|Newest|Watched|Told)\b"
)
#: Names that programs outside read: conditions of a study, a key of the JSON of `ebac identify log` (see DECISIONS).
KEPT = re.compile(r'"told(-[\w.+-]+)?"|[\'"`]told-')
TOLD = re.compile(r"\b(told|tells?)\b(?!\()")


def test_no_house_word_is_left_in_the_package() -> None:
    found = []
    for path in sorted(PACKAGE.rglob("*.py")):
        for line in path.read_text(encoding="utf-8").splitlines():
            if WORDS.search(line) or (TOLD.search(line) and not KEPT.search(line)):
                found.append(f"{path.relative_to(PACKAGE)}: {line.strip()}")
    assert not found


def test_no_paragraph_is_a_wall_of_text() -> None:
    long = []
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))):
        no_prose = r"^```.*?^```|^ *\|.*?$|^<!--.*?-->"
        text = re.sub(no_prose, "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
        for paragraph in re.split(r"\n\s*\n|\n(?=\s*(?:[*-]|\d+\.) )", text):
            if (words := len(paragraph.split())) > LONGEST:
                long.append(f"{page.relative_to(ROOT)}: {words} words: {paragraph.strip()[:60]}")
    assert not long, "\n".join(long)
