"""Particles of a homogeneous box: a lattice along its edges."""

import numpy as np
from numpy.typing import NDArray


def box_points(lattice: tuple[int, int, int], size: tuple[float, float, float]) -> NDArray[np.float64]:
    """Centres of the cells into which a lattice divides a box around the origin.

    Args:
        lattice: cells along each edge.
        size: edges [m].

    Returns:
        Positions [m], shape [count, 3].
    """
    axes = [edge * ((np.arange(count) + 0.5) / count - 0.5) for count, edge in zip(lattice, size, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
