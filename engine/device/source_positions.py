"""Faster start: Taichi words the place in the source of every expression that it translates, and of each one anew.

Kernels inline the same few functions many times over. Wording a place once takes half of a kernel's translation away.
"""

import ast
from typing import Any

from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext

Place = tuple[Any, ...]

_worded: dict[Place, str] = {}
_word = ASTTransformerContext.get_pos_info


def place_in_source(context: Any, node: ast.stmt | ast.expr) -> str:
    """The file, line and text of a piece of code, as Taichi's error messages name them.

    Args:
        context: the function that is being translated.
        node: a piece of its code.
    """
    key = (context.file, context.lineno_offset, context.func.func.__name__, type(node), *_extent(node))
    if key not in _worded:
        _worded[key] = _word(context, node)
    return _worded[key]


def _extent(node: ast.stmt | ast.expr) -> tuple[int | None, ...]:
    return node.lineno, node.end_lineno, node.col_offset, node.end_col_offset


def word_places_once() -> None:
    """Let Taichi remember the places that it has worded."""
    ASTTransformerContext.get_pos_info = place_in_source
