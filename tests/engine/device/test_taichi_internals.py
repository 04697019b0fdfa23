"""The private names of Taichi that the engine uses exist in the installed version, with their meaning."""

import ast
import inspect
from pathlib import Path

import numpy as np
import pytest
import taichi as ti

from engine.device import taichi_internals
from engine.device.backend import Real, mat3, on_gpu
from engine.device.taichi_internals import (
    ASTTransformerContext,
    Field,
    StructField,
    ast_transformer_utils,
    compiled,
    current_cfg,
    is_arch_supported,
    is_kernel,
    kernel_impl,
    launch,
    to_numpy_type,
)

ENGINE = Path(taichi_internals.__file__).parents[1]


@ti.data_oriented
class Part:
    def __init__(self, increment: int = 1) -> None:
        self.total, self.increment = ti.field(ti.i32, ()), increment

    @ti.kernel
    def kernel(self):
        self.total[None] += self.increment

    @ti.func
    def function(self):
        pass


@pytest.mark.usefixtures("taichi")
def test_fields_are_told_apart_and_count_their_components():
    struct = ti.types.struct(a=Real, b=mat3).field(shape=3)
    assert isinstance(struct, StructField) and isinstance(struct, Field)
    assert set(struct.keys) == {"a", "b"} and isinstance(struct.get_member_field("a"), Field)
    matrix = struct.get_member_field("b")
    assert (matrix.n, matrix.m) == (3, 3)


def test_types_of_the_device_have_types_of_the_host():
    assert [np.dtype(to_numpy_type(kind)).name for kind in (ti.f64, ti.f32, ti.i32)] == ["float64", "float32", "int32"]


@pytest.mark.usefixtures("taichi")
def test_the_running_architecture_is_known():
    assert current_cfg().arch == ti.cpu and is_arch_supported(ti.cpu)
    assert not on_gpu()


def test_the_compiler_reads_source_code_by_the_names_that_are_cached():
    reads, tells = inspect.getsource(kernel_impl), inspect.getsource(ast_transformer_utils)
    for call in ("= getsourcefile(", "= getsourcelines(", "textwrap.fill(", "textwrap.dedent("):
        assert call in reads
    assert "TextWrapper(" in tells and reads.count("textwrap.") == 2, "nothing else of textwrap is in use"


def test_kernels_are_known_by_their_mark():
    assert is_kernel(vars(Part)["kernel"])
    assert not is_kernel(vars(Part)["function"])


@pytest.mark.usefixtures("taichi")
def test_a_compiled_kernel_is_that_of_its_object_and_runs_at_every_launch():
    one, three = Part(1), Part(3)
    ready = [compiled(one.kernel), compiled(three.kernel)]
    assert (one.total[None], three.total[None]) == (0, 0)
    for kernel in (*ready, *ready):
        launch(kernel)
    assert (one.total[None], three.total[None]) == (2, 6)


def test_the_compiler_asks_for_source_positions():
    assert callable(ASTTransformerContext.get_pos_info)


def test_no_other_file_imports_them():
    found = {
        path.name
        for path in ENGINE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if (isinstance(node, ast.ImportFrom) and str(node.module).startswith("taichi.lang"))
        or (isinstance(node, ast.Attribute) and ast.unparse(node).startswith("ti.lang"))
    }
    assert found == {"taichi_internals.py"}
