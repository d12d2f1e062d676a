"""Doxygen over the headers before the build, and `.. headers:: FOLDER`: what each header of a folder declares."""

import re
import subprocess
from pathlib import Path
from xml.etree import ElementTree

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from sphinx.util.nodes import nested_parse_with_titles

CPP = Path(__file__).parents[2] / "cpp"
#: What a header shows: no namespaces, which every header opens again.
SECTIONS = "briefdescription detaileddescription innerclass define typedef enum func var"
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
        names = doxygen_names(xml_folder(self.env.app))
        lines: list[str] = []
        for header in sorted((CPP / "ebac" / self.arguments[0]).glob("*.hpp")):
            path = header.relative_to(CPP).as_posix()
            lines += [path, "-" * len(path), "", f".. doxygenfile:: {names[path]}"]
            lines += [f"   :sections: {SECTIONS}", ""]
            self.env.note_dependency(str(header))
        holder = nodes.section()
        holder.document = self.state.document
        nested_parse_with_titles(self.state, StringList(lines, source=self.arguments[0]), holder)
        return list(holder.children)


def xml_folder(app: Sphinx) -> Path:
    """Where Doxygen leaves its XML: beside the doctrees, outside of the site."""
    return Path(app.doctreedir) / "doxygen" / "xml"


def doxygen_names(xml: Path) -> dict[str, str]:
    """Return what Doxygen calls each header: its bare name where no other has it."""
    index = ElementTree.parse(xml / "index.xml")
    found = {}
    for file in index.iterfind("compound[@kind='file']"):
        page = ElementTree.parse(xml / f"{file.get('refid')}.xml")
        location = page.find("compounddef/location")
        assert location is not None
        found[str(location.get("file"))] = str(file.findtext("name"))
    return found


def run_doxygen(app: Sphinx) -> None:
    """Read the headers and tell Breathe where the result lies."""
    folder = xml_folder(app)
    folder.parent.mkdir(parents=True, exist_ok=True)
    settings = SETTINGS | {"OUTPUT_DIRECTORY": folder.parent}
    text = "".join(f"{key} = {value}\n" for key, value in settings.items())
    subprocess.run(["doxygen", "-"], input=text, text=True, check=True)
    for page in folder.glob("*.xml"):
        page.write_text(INITIALIZER.sub("", page.read_text(encoding="utf-8")), encoding="utf-8")
    app.config.breathe_projects = {"ebac": str(folder)}


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive; Doxygen runs before Breathe looks for its result."""
    app.add_directive("headers", Headers)
    app.connect("builder-inited", run_doxygen, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
