"""`{drawn} FILE`: runs the commands of its body in an empty folder, shows them and the picture they leave in FILE."""

import hashlib
import os
import shutil
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from drawing import draw
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

LOGGER = logging.getLogger(__name__)


class Drawn(SphinxDirective):
    """A picture and the commands that draw it; they run again when the page changes or is built from nothing."""

    required_arguments = 1
    has_content = True
    option_spec: ClassVar[dict[str, Any]] = {"alt": directives.unchanged_required}

    def run(self) -> list[nodes.Node]:
        script = "\n".join(self.content)
        name = hashlib.sha256(f"{script}\n{self.arguments[0]}".encode()).hexdigest()[:16]
        picture = (
            Path(self.env.app.doctreedir) / "drawn" / f"{name}{Path(self.arguments[0]).suffix}"
        )
        if not picture.exists():
            self.draw(script, picture)
        source = os.path.relpath(picture, Path(self.env.doc2path(self.env.docname)).parent)
        box = nodes.literal_block(script, script, language="sh")
        return [box, *self.parse_text_to_nodes(f"![{self.options['alt']}]({source})")]

    def draw(self, script: str, picture: Path) -> None:
        """Run the commands and keep the picture."""
        room = picture.with_suffix("")
        shutil.rmtree(room, ignore_errors=True)
        room.mkdir(parents=True)
        error = draw(script, room)
        drawn = room / self.arguments[0]
        if error or not drawn.exists():
            LOGGER.warning("no %s: %s", self.arguments[0], error, location=self.get_location())
            return
        drawn.replace(picture)
        shutil.rmtree(room)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("drawn", Drawn)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
