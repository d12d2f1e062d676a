"""Tables of the columns of a trace: `{trace-columns} every`, `law`, `true`, `drives`, `log`."""

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from trace_tables import TABLES


class TraceColumns(SphinxDirective):
    """Shows one of `TABLES`."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        head, *rows = TABLES[self.arguments[0]]()
        lines = [head, tuple("---" for _ in head), *rows]
        escaped = [[cell.replace("|", r"\|") for cell in cells] for cells in lines]
        return self.parse_text_to_nodes("\n".join(f"| {' | '.join(row)} |" for row in escaped))


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("trace-columns", TraceColumns)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
