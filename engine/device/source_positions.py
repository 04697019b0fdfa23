"""Cache the source positions that Taichi's compiler writes into its error messages.

Taichi's compiler builds a text with file and line for every expression it translates, also where a function is inlined
many times. Cached, a cold start takes half the translation time.
"""

import ast

from engine.device.taichi_internals import ASTTransformerContext

Key = tuple[object, ...]
"""File, line offset, function, kind and extent of a piece of source code."""

_cache: dict[Key, str] = {}
_build_text = ASTTransformerContext.get_pos_info


def cache_source_positions() -> None:
    """Replace Taichi's method that builds these texts, for the whole process."""
    ASTTransformerContext.get_pos_info = source_position


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
