"""Cache what Taichi's compiler reads of source code, and the positions in it that its error messages name.

Taichi's compiler looks up the source of a function wherever it is inlined, and builds a text with file and line for
every expression it translates. Cached, a cold start takes half the translation time.
"""

import ast
import textwrap
from functools import cache
from types import SimpleNamespace

from engine.device.taichi_internals import ASTTransformerContext, ast_transformer_utils, kernel_impl

Key = tuple[object, ...]
"""File, line offset, function, kind and extent of a piece of source code."""

_cache: dict[Key, str] = {}
_build_text = ASTTransformerContext.get_pos_info
_lines_of, _file_of = cache(kernel_impl.getsourcelines), cache(kernel_impl.getsourcefile)
_filled = cache(textwrap.fill)


class LineWrapper(textwrap.TextWrapper):
    """Wraps as its base class does, but leaves a line that needs no wrapping whole at once."""

    def wrap(self, text: str) -> list[str]:
        """Return the lines of a text, without white space at their ends."""
        if len(text) > self.width or not text.isprintable():
            return super().wrap(text)
        line = text.rstrip()
        return [line] if line else []


def cache_source_positions() -> None:
    """Replace what Taichi reads source code and builds these texts with, for the whole process."""
    ASTTransformerContext.get_pos_info = source_position
    ast_transformer_utils.TextWrapper = LineWrapper
    kernel_impl.getsourcelines, kernel_impl.getsourcefile = _lines_of, _file_of
    kernel_impl.textwrap = SimpleNamespace(fill=_filled, dedent=textwrap.dedent)


def source_position(context: ASTTransformerContext, node: ast.stmt | ast.expr) -> str:
    """Return file, line and text of a piece of code, as Taichi's error messages name them.

    Args:
        context: the function that is being translated.
        node: a piece of its code.
    """
    key = (context.file, context.lineno_offset, context.func.func.__name__, type(node), *_extent(node))
    if key not in _cache:
        _cache[key] = _build_text(context, node)
    return _cache[key]


def _extent(node: ast.stmt | ast.expr) -> tuple[int | None, ...]:
    return node.lineno, node.end_lineno, node.col_offset, node.end_col_offset
