"""A lit picture of a clump: its particles as balls, seen from far away."""

from dataclasses import dataclass

import numpy as np
from matplotlib.colors import LightSource, to_rgb
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from analysis.remnant.particles import Array
from analysis.report.figures.style import BLUE, ORANGE

BALL = 0.8
"""Radius of a particle's ball in particle spacings: large enough to close the surface."""

SMOOTHING = 0.5
"""Width of the smoothing of the surface before it is lit, in particle spacings."""

LIGHT = LightSource(azdeg=315, altdeg=42)

ROCKS = np.array([to_rgb(colour) for colour in (BLUE, ORANGE)]) * 0.45 + 0.5
"""Colours of the particles of the first and the second body; further bodies repeat them."""


@dataclass(frozen=True)
class Picture:
    """A picture with transparent background.

    Attributes:
        pixels: red, green, blue, alpha [0..255], shape [height, width, 4], lowest row first.
        extent: left, right, bottom, top [m] from the clump's centre of mass.
    """

    pixels: NDArray[np.uint8]
    extent: tuple[float, float, float, float]


def picture(view: Array, body: NDArray[np.int64], spacing: float, pixel: float) -> Picture:
    """Particles as lit balls in the colours of their bodies.

    Args:
        view: to the right, up, and towards the viewer [m], shape [particle_count, 3].
        body: index of the body, shape [particle_count].
        spacing: particle spacing h [m].
        pixel: edge of a pixel [m].
    """
    radius = BALL * spacing
    corner = view[:, :2].min(axis=0) - 2.0 * radius
    width, height = np.ceil((view[:, :2].max(axis=0) + 2.0 * radius - corner) / pixel).astype(int)
    depth, nearest = _nearest(view, (view[:, :2] - corner) / pixel, radius, pixel, (height, width))
    solid = nearest >= 0
    # hillshade takes the first row for the top one; here it is the bottom one.
    light = LIGHT.hillshade(_smooth(depth, solid, SMOOTHING * spacing / pixel), dx=pixel, dy=-pixel)
    colours = ROCKS[body[nearest] % len(ROCKS)] * (0.25 + 0.8 * light[..., None])
    right, top = corner + pixel * np.array([width, height])
    pixels = np.dstack([colours.clip(0.0, 1.0), solid])
    return Picture((255.0 * pixels).astype(np.uint8), (float(corner[0]), float(right), float(corner[1]), float(top)))


def _nearest(
    view: Array, position: Array, radius: float, pixel: float, shape: tuple[int, int]
) -> tuple[Array, NDArray[np.int64]]:
    """Depth [m] of the surface and the particle it belongs to, -1 for none, for each pixel."""
    depth, nearest = np.full(shape, -np.inf), np.full(shape, -1)
    reach = int(np.ceil(radius / pixel))
    for right, up in np.ndindex(2 * reach + 1, 2 * reach + 1):
        column, row = np.floor(position + np.array([right - reach, up - reach])).astype(int).T
        offset = (np.stack([column, row], axis=1) + 0.5 - position) * pixel
        below = radius**2 - np.sum(offset**2, axis=1)
        inside = np.flatnonzero(below > 0.0)
        row, column = row[inside], column[inside]
        surface = view[inside, 2] + np.sqrt(below[inside])
        np.maximum.at(depth, (row, column), surface)
        seen = depth[row, column] == surface
        nearest[row[seen], column[seen]] = inside[seen]
    return depth, nearest


def _smooth(depth: Array, solid: NDArray[np.bool_], width: float) -> Array:
    """The surface smoothed, without letting the background into it."""
    weight = gaussian_filter(solid.astype(np.float64), width)
    filled = gaussian_filter(np.where(solid, depth, 0.0), width)
    return np.asarray(filled / np.maximum(weight, 1e-3))
