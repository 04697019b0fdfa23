"""Device functions run over arrays, so that a law can be tested alone; random tensors to run them on."""

import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.device.backend import Real, mat3, vec3, vec6
from engine.device.fields import allocate, capacity, overwrite
from engine.device.permutation import Permutation
from engine.simulation.simulation import Simulation
from engine.state.particles import Particles

Array = NDArray[Any]
Shape = tuple[int, ...]


def field(shape: Shape, count: int, dtype: Any = Real) -> Any:
    """A field of `count` scalars, vectors or matrices."""
    return allocate({(): dtype, (3,): vec3, (6,): vec6, (3, 3): mat3}[shape], capacity(count))


def evaluate(function: Callable[..., Any], *inputs: Array, outputs: tuple[Shape, ...] = ((),)) -> list[Array]:
    """What a device function returns for every entry of the inputs, one array per returned value."""
    count = len(inputs[0])
    given = [field(values.shape[1:], count, ti.i32 if values.dtype == np.int32 else Real) for values in inputs]
    for entries, values in zip(given, inputs, strict=True):
        overwrite(entries, values)
    results = [field(shape, count) for shape in outputs]

    @ti.kernel
    def run():
        for i in range(count):
            result = function(*[entries[i] for entries in ti.static(given)])
            if ti.static(len(results) == 1):
                results[0][i] = result
            else:
                for k in ti.static(range(len(results))):
                    results[k][i] = result[k]

    run()
    return [result.to_numpy()[:count] for result in results]


def rotations(generator: np.random.Generator, count: int) -> Array:
    """Rotation matrices without a preferred axis, shape [count, 3, 3]."""
    return np.asarray(Rotation.random(count, random_state=generator).as_matrix())


def compose(values: Array, vectors: Array) -> Array:
    """Symmetric tensors of these eigenvalues and eigenvectors (columns)."""
    tensors = np.einsum("nik,nk,njk->nij", vectors, values, vectors)
    return np.asarray(0.5 * (tensors + tensors.transpose(0, 2, 1)))


def transform(function: Callable[[Array], Array], tensors: Array) -> Array:
    """`function` of symmetric tensors, by their eigenvalues."""
    values, vectors = np.linalg.eigh(tensors)
    return compose(function(values), vectors)


def traceless(tensors: Array) -> Array:
    """Deviators of tensors."""
    return np.asarray(tensors - np.trace(tensors, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3))


def norm(tensors: Array) -> Array:
    """Frobenius norm of every tensor."""
    return np.asarray(np.sqrt(np.einsum("nij,nij->n", tensors, tensors)))


COMPARED: dict[str, tuple[int, float]] = {}
"""Inputs tried and largest error by test, filled by `worst` and printed by tests/helpers/laws.py."""


def worst(found: Array, expected: Array, scale: Array | float) -> float:
    """Largest difference in units of `scale`, which has one entry per row or is common to all."""
    difference = np.abs(found - expected).reshape(len(found), -1).max(axis=1)
    share = np.divide(difference, scale, out=np.where(difference > 0.0, np.inf, 0.0), where=np.asarray(scale) > 0.0)
    assert not np.isnan(share).any()
    _record(len(found), float(share.max()))
    return float(share.max())


def _record(inputs: int, error: float) -> None:
    test = os.environ["PYTEST_CURRENT_TEST"].split("[")[0].split(" ")[0]
    before, largest = COMPARED.get(test, (0, 0.0))
    COMPARED[test] = (before + inputs, max(largest, error))


def moved(particles: Particles, generator: np.random.Generator) -> Array:
    """Move particles at random on the device; returns the number in the scene of each."""
    permutation = Permutation(particles.fields, capacity(particles.count))
    source = generator.permutation(particles.count)
    order = particles.order[source]
    overwrite(permutation.source, source)
    permutation.apply(particles.count)
    return order


def finds(simulation: Simulation, name: str, numbers: Sequence[float]) -> list[bool]:
    """Whether the ledger of calm particles finds numbers that are not finite, each put in place of one of theirs."""
    calm, found = simulation.particles.read(name)[name], []
    assert simulation.ledger.extremes().is_finite
    for number in numbers:
        values = calm.copy()
        values[(7,) + (-1,) * (calm.ndim - 1)] = number
        simulation.particles.write({name: values})
        found.append(not simulation.ledger.extremes().is_finite)
    simulation.particles.write({name: calm})
    return found
