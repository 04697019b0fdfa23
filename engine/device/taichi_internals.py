"""All names of Taichi in use that its public interface does not promise.

They exist in taichi >= 1.7.3, < 1.8, the versions that pyproject.toml allows;
tests/engine/device/test_taichi_internals.py checks each of them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from taichi.lang import kernel_impl
from taichi.lang.ast import ast_transformer_utils
from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext
from taichi.lang.field import Field
from taichi.lang.impl import current_cfg, get_runtime
from taichi.lang.misc import is_arch_supported
from taichi.lang.struct import StructField
from taichi.lang.util import to_numpy_type

__all__ = [
    "ASTTransformerContext",
    "Field",
    "StructField",
    "ast_transformer_utils",
    "compiled",
    "current_cfg",
    "is_arch_supported",
    "is_kernel",
    "kernel_impl",
    "launch",
    "to_numpy_type",
]


def is_kernel(function: object) -> bool:
    """Whether an attribute of a class was decorated with `ti.kernel`."""
    return hasattr(function, "_is_wrapped_kernel")


@dataclass(frozen=True)
class Compiled:
    """A kernel of an object, ready to be launched.

    Attributes:
        kernel: Taichi's representation.
        code: for the device.
    """

    kernel: Any
    code: Any


def compiled(bound: Callable[[], None]) -> Compiled:
    """Compile a kernel of an object, without arguments."""
    primal, program = bound._primal, get_runtime().prog  # type: ignore[attr-defined]
    kernel = primal.compiled_kernels[primal.ensure_compiled(bound._kernel_owner)]  # type: ignore[attr-defined]
    return Compiled(kernel, program.compile_kernel(program.config(), program.get_device_caps(), kernel))


def launch(kernel: Compiled) -> None:
    """Launch a compiled kernel."""
    get_runtime().prog.launch_kernel(kernel.code, kernel.kernel.make_launch_context())
