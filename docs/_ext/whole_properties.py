"""A property is told by its whole docstring: napoleon takes "The hand: ..." in its first line for a type."""

from typing import Any

from sphinx.ext.napoleon.docstring import NumpyDocstring


def _whole(self: NumpyDocstring) -> tuple[str, list[str]]:
    lines = self._dedent(self._consume_to_end())
    return "", self.__class__(lines, self._config).lines()


def setup(app: Any) -> dict[str, bool]:
    """Let Sphinx know."""
    NumpyDocstring._consume_inline_attribute = _whole  # type: ignore[method-assign]
    return {"parallel_read_safe": True}
