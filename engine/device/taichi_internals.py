"""All names of Taichi in use that its public interface does not promise.

They exist in taichi >= 1.7.3, < 1.8, the versions that pyproject.toml allows;
tests/engine/device/test_taichi_internals.py checks each of them.
"""

from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext
from taichi.lang.field import Field
from taichi.lang.impl import current_cfg
from taichi.lang.misc import is_arch_supported
from taichi.lang.struct import StructField
from taichi.lang.util import to_numpy_type

__all__ = [
    "ASTTransformerContext",
    "Field",
    "StructField",
    "current_cfg",
    "is_arch_supported",
    "is_kernel",
    "to_numpy_type",
]


def is_kernel(function: object) -> bool:
    """Whether an attribute of a class was decorated with `ti.kernel`."""
    return hasattr(function, "_is_wrapped_kernel")
