"""The site: `sphinx-build -W docs build/docs`. Notebooks are executed, the reference is read from the code."""

import re
import shutil
import sys
from importlib.metadata import version as installed
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))

project = "ebac"
copyright = "The ebac developers, BSD-3-Clause"  # noqa: A001
version = release = installed("ebac")

extensions = [
    "myst_nb",  # Markdown pages, and notebooks written as Markdown
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",  # NumPy docstrings
    "sphinx.ext.duration",
    "public_names",  # `.. public::`: all of a package's public names, none forgotten
    "error_tables",  # tables of faults and errors, from the code
    "trace_columns",  # tables of the columns of a trace, from the core
    "short_contents",  # the navigation, from titles alone
    "repository_links",  # links to files of the repository that are no pages
    "whole_properties",  # no types in docstrings of properties
    "commands",  # `{commands}`: the command line, from the program
    "drawn",  # `{drawn}`: pictures of the gallery
    "live_page",  # live/index.html, the loop in a browser
    "mathml",  # equations without a script
    "sphinx_copybutton",
]
exclude_patterns = ["_build", "figures/*.py", "jupyter_execute"]
html_theme = "furo"
html_title = f"ebac {release}"
html_static_path = ["_static"]
html_css_files = ["ebac.css"]
html_copy_source = False
html_theme_options = {"navigation_with_keys": True}
pygments_style = "friendly"
pygments_dark_style = "native"

# Types in docstrings are sentences ("array, shape (rows,)"), whose words are no names to link.
suppress_warnings = ["ref.python"]

# C++: Doxygen reads the headers, Breathe shows them. Where Doxygen is missing, that part alone is left out.
if shutil.which("doxygen"):
    extensions += ["breathe", "headers"]
    breathe_default_project = "ebac"
    breathe_default_members = ("members",)
    breathe_show_include = False
    cpp_id_attributes = ["EBAC_RT"]
else:
    exclude_patterns.append("reference/cpp/*")
    suppress_warnings.append("toc.excluded")

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_dmath_allow_digits = False  # "$5 and $6" is no equation
html_math_renderer = "mathml"
math_eqref_format = "(T{number})"  # the numbers of the paper have no letter
copybutton_exclude = ".linenos, .gp, .go"
myst_heading_anchors = 3
nb_execution_mode = "cache"  # executed again when a notebook changes; CI builds from nothing
nb_execution_in_temp = True  # as its reader does, who has no clone
nb_execution_timeout = 600  # CI gives it what its tests leave
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_merge_streams = True

autodoc_typehints = "signature"  # the docstrings have shapes and units, too
autodoc_type_aliases = {
    name: name for name in ("AnyLaw", "ArrayLike", "Environment", "Laws", "Progress")
}
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 100  # a longer signature has one parameter a line
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
toc_object_entries_show_parents = "hide"

#: `NDArray`, and an alias inside of another type, as annotations are evaluated.
ARRAY = re.compile(r"~?(?:numpy\.)?ndarray\[.*?dtype\[[^]]*\]\]")
ALIAS = re.compile(r"TypeAliasForwardRef\('(\w+)'\)")


def shorten(
    app: Any, what: str, name: str, thing: Any, options: Any, signature: Any, returns: Any
) -> tuple[str | None, str | None]:
    """Write arrays as `ndarray`, whose shapes are in the docstrings, and aliases by their names."""

    def short(text: str | None) -> str | None:
        return text and ALIAS.sub(r"\1", ARRAY.sub("~numpy.ndarray", text))

    return short(signature), short(returns)


def setup(app: Any) -> None:
    """Shorten the signatures of the reference."""
    app.connect("autodoc-process-signature", shorten)
