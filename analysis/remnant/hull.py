"""The convex hull of a clump: a second measure of its shape, independent of the particles inside."""

from dataclasses import dataclass

import numpy as np
import trimesh

from analysis.remnant.ellipsoid import Ellipsoid, ellipsoid_from, ellipsoid_of
from analysis.remnant.particles import Array

NAN = float("nan")


@dataclass(frozen=True)
class Hull:
    """A convex body around a clump.

    Attributes:
        volume: [m^3].
        ellipsoid: the uniform ellipsoid with the inertia tensor of the solid hull.
        extents: edges of the box around it along that ellipsoid's axes [m], shape [3]. (The box of smallest volume
            has no definite edges: around a nearly round body very different boxes are almost equally small.)
    """

    volume: float
    ellipsoid: Ellipsoid
    extents: Array


UNDEFINED = Hull(NAN, Ellipsoid(np.full(3, NAN), np.full((3, 3), NAN)), np.full(3, NAN))
"""The hull of points that span no volume."""


def hull_of(position: Array) -> Hull:
    """The convex hull of points, or `UNDEFINED` where they lie in one plane.

    Args:
        position: [m], shape [particle_count, 3].
    """
    extent = ellipsoid_of(position, np.ones(len(position))).axes
    if len(position) < 4 or extent[2] == 0.0:
        return UNDEFINED
    # trimesh's tolerances are absolute: it gets coordinates of order one around the origin.
    scaled = (position - position.mean(axis=0)) / extent[0]
    return hull_of_mesh(trimesh.PointCloud(scaled).convex_hull, float(extent[0]))


def hull_of_mesh(mesh: trimesh.Trimesh, scale: float = 1.0) -> Hull:
    """The measures of a closed convex mesh.

    Args:
        mesh: triangles around the solid.
        scale: length [m] of one unit of the mesh.
    """
    volume = float(mesh.volume)
    shape = ellipsoid_from(np.asarray(mesh.moment_inertia), volume)
    extents = np.ptp(mesh.vertices @ shape.directions.T, axis=0)
    return Hull(volume * scale**3, Ellipsoid(shape.axes * scale, shape.directions), extents * scale)
