"""Doxygen over the headers before the build, and `.. headers:: FOLDER`: what each header of a folder declares."""

import re
import subprocess
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from sphinx.util.nodes import nested_parse_with_titles

CPP = Path(__file__).parents[2] / "cpp"
#: Marks of reStructuredText, which comments in C++ do not mean.
SPECIAL = re.compile(r"([*`|_\\])")
#: Initial values in braces, which Sphinx's parser of C++ does not read; plain numbers stay.
INITIALIZER = re.compile(
    r"<initializer>(?:(?!</initializer>).)*[{\[](?:(?!</initializer>).)*</initializer>", re.S
)
SETTINGS = {
    "PROJECT_NAME": "ebac",
    "INPUT": CPP,
    "FILE_PATTERNS": "*.hpp",
    "RECURSIVE": "YES",
    "STRIP_FROM_PATH": CPP,
    "GENERATE_HTML": "NO",
    "GENERATE_LATEX": "NO",
    "GENERATE_XML": "YES",
    "XML_PROGRAMLISTING": "NO",
    "HAVE_DOT": "NO",
    "JAVADOC_AUTOBRIEF": "YES",
    "EXTRACT_ALL": "YES",
    "EXTRACT_STATIC": "YES",
    "HIDE_FRIEND_COMPOUNDS": "YES",
    "MACRO_EXPANSION": "YES",
    "EXPAND_ONLY_PREDEF": "YES",
    "PREDEFINED": "EBAC_RT=noexcept",
    "QUIET": "YES",
    "WARNINGS": "NO",
}


class Headers(SphinxDirective):
    """Shows every header below `cpp/ebac/FOLDER` under a heading of its own."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        xml = xml_folder(self.env.app)
        pages = doxygen_pages(xml)
        lines: list[str] = []
        for header in sorted((CPP / "ebac" / self.arguments[0]).glob("*.hpp")):
            path = header.relative_to(CPP).as_posix()
            lines += [path, "-" * len(path), "", *types(pages[path]), *free(pages[path])]
            self.env.note_dependency(str(header))
        holder = nodes.section()
        holder.document = self.state.document
        nested_parse_with_titles(self.state, StringList(lines, source=self.arguments[0]), holder)
        return list(holder.children)


def types(page: ElementTree.Element) -> Iterator[str]:
    """Directives of the types a header declares; those inside another type are shown by it, specialisations by none."""
    names = {inner.text: str(inner.get("refid")) for inner in page.iterfind("innerclass")}
    for name, refid in names.items():
        if (
            name
            and "<" not in name
            and name.rpartition("::")[0] not in names
            and "anonymous" not in name
        ):
            kind = "doxygenclass" if refid.startswith("class") else "doxygenstruct"
            yield from (f".. {kind}:: {name}", "   :members:", "")


def free(page: ElementTree.Element) -> Iterator[str]:
    """What a header declares beside its types, each with its comment."""
    for member in page.iterfind("sectiondef/memberdef"):
        declared = " ".join(text(member, "definition").split()) + text(member, "argsstring")
        if member.get("kind") in ("enum", "define"):
            values = [text(value, "name") for value in member.iterfind("enumvalue")]
            kind = "enum class" if member.get("kind") == "enum" else "#define"
            declared = f"{kind} {text(member, 'name')}"
            declared += f" {{ {', '.join(values)} }}" if values else ""
        if declared:
            yield from (".. code-block:: cpp", "", f"   {declared}", "")
        comment = " ".join("".join(part.itertext()) for part in member.iterfind("briefdescription"))
        if told := " ".join(comment.split()):
            yield from (SPECIAL.sub(r"\\\1", told), "")


def text(member: ElementTree.Element, tag: str) -> str:
    """All text below a child of a member."""
    found = member.find(tag)
    return "" if found is None else "".join(found.itertext())


def xml_folder(app: Sphinx) -> Path:
    """Where Doxygen leaves its XML: beside the doctrees, outside of the site."""
    return Path(app.doctreedir) / "doxygen" / "xml"


@cache
def doxygen_pages(xml: Path) -> dict[str, ElementTree.Element]:
    """Return what Doxygen says of each header, by its path."""
    index = ElementTree.parse(xml / "index.xml")
    found = {}
    for file in index.iterfind("compound[@kind='file']"):
        page = ElementTree.parse(xml / f"{file.get('refid')}.xml").find("compounddef")
        assert page is not None
        location = page.find("location")
        assert location is not None
        found[str(location.get("file"))] = page
    return found


def run_doxygen(app: Sphinx) -> None:
    """Read the headers and tell Breathe where the result lies."""
    folder = xml_folder(app)
    folder.parent.mkdir(parents=True, exist_ok=True)
    settings = SETTINGS | {"OUTPUT_DIRECTORY": folder.parent}
    text = "".join(f"{key} = {value}\n" for key, value in settings.items())
    subprocess.run(["doxygen", "-"], input=text, text=True, check=True)
    doxygen_pages.cache_clear()
    for page in folder.glob("*.xml"):
        page.write_text(INITIALIZER.sub("", page.read_text(encoding="utf-8")), encoding="utf-8")
    app.config.breathe_projects = {"ebac": str(folder)}


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive; Doxygen runs before Breathe looks for its result."""
    app.add_directive("headers", Headers)
    app.connect("builder-inited", run_doxygen, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
