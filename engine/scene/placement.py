"""Where the particles of a homogeneous sphere or box are, around its centre."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

FACE_CENTRED = np.array([[0.0, 0.0, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]])


def sphere_points(count: int, radius: float, generator: np.random.Generator) -> NDArray[np.float64]:
    """Exactly `count` points of a randomly turned and shifted face-centred lattice, centred on their mean.

    Uniform, without a preferred direction, and the same for the same generator.

    Args:
        count: number of points.
        radius: radius of the sphere [m].
        generator: source of randomness.

    Returns:
        Positions [m], shape [count, 3].
    """
    cell = (4.0 * 4.0 / 3.0 * np.pi / count) ** (1.0 / 3.0)
    reach = int(np.ceil(1.0 / cell)) + 2
    corners = np.arange(-reach, reach)
    grid = np.stack(np.meshgrid(corners, corners, corners, indexing="ij"), axis=-1).reshape(-1, 1, 3)
    lattice = (grid + FACE_CENTRED).reshape(-1, 3) + generator.random(3)
    points = cell * Rotation.from_quat(generator.normal(size=4)).apply(lattice)
    nearest = np.argsort(np.einsum("ij,ij->i", points, points), kind="stable")[:count]
    chosen = points[np.sort(nearest)]
    return radius * np.asarray(chosen - chosen.mean(axis=0))


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
