"""The volume that a remnant fills, with the pores between its particles.

It errs by at most 4 % for 1,000 to 4,000 particles in a sphere or an ellipsoid of 1 : 0.93 : 0.24 or 1 : 0.2 : 0.13,
whether they lie on a lattice or at random.
"""

import numpy as np
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from analysis.remnant.particles import Array

CLOSING = 1.5
"""Radius [h] of the balls that close pores; of 1 h, they leave 20 % of the volume of particles at random open."""

SURFACE = 0.5
"""Distance [h] of the surface beyond the outermost particles."""

VOXELS = 4
"""Voxels per particle spacing, fewer where more than `MOST_VOXELS` would be needed."""

MOST_VOXELS = 5e6
"""Voxels whose distances take some 200 MB."""


def filled_volume(position: Array, spacing: float) -> float:
    """Volume [m^3] of a clump after its pores are closed.

    Space within `CLOSING` of a particle is filled; its surface is then moved inward, to `SURFACE` beyond the outermost
    particles.

    Args:
        position: [m], shape [particle_count, 3].
        spacing: particle spacing h [m].
    """
    margin = 2.0 * CLOSING * spacing
    centred = position - position.mean(axis=0)
    along = centred @ np.linalg.svd(centred.T @ centred)[0]
    low, high = along.min(axis=0) - margin, along.max(axis=0) + margin
    edge = max(spacing / VOXELS, float((np.prod(high - low) / MOST_VOXELS) ** (1.0 / 3.0)))
    lines = [np.arange(*ends, edge) for ends in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1)
    distance, _ = cKDTree(along).query(grid, distance_upper_bound=CLOSING * spacing)
    depth = distance_transform_edt(np.isfinite(distance)) * edge
    return float(np.count_nonzero(depth > (CLOSING - SURFACE) * spacing) * edge**3)
