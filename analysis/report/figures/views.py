"""The largest remnants of jobs in their principal axes, as pictures of one scale."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from analysis.remnant.ellipsoid import ellipsoid_of
from analysis.remnant.particles import Particles
from analysis.report.figures.surface import Picture, picture

PIXELS = 720
"""Pixels across the longest remnant, at most."""

FINEST = 12.0
"""Pixels across a particle spacing, at most: more would only show the balls."""


@dataclass(frozen=True)
class Views:
    """Pictures of a remnant, its longest axis to the right.

    Attributes:
        flat: seen along the shortest axis.
        edge: seen along the intermediate axis.
    """

    flat: Picture
    edge: Picture


@dataclass(frozen=True)
class Frame:
    """Size of a panel around any of the pictures.

    Attributes:
        width: half of its width [m].
        flat, edge: half of the height of each view [m].
    """

    width: float
    flat: float
    edge: float


def views_of(remnants: Iterable[Particles]) -> list[Views]:
    """Both views of each remnant, all with the same pixel size."""
    aligned = [_aligned(remnant) for remnant in remnants]
    longest = max(float(np.ptp(remnant.position[:, 0])) + remnant.spacing for remnant in aligned)
    finest = min(remnant.spacing for remnant in aligned) / FINEST
    return [_views(remnant, max(longest / PIXELS, finest)) for remnant in aligned]


def frame_around(views: list[Views]) -> Frame:
    """The smallest frame around all pictures."""
    flat = np.abs([found.flat.extent for found in views]).max(axis=0)
    edge = np.abs([found.edge.extent for found in views]).max(axis=0)
    return Frame(float(flat[:2].max()), float(flat[2:].max()), float(edge[2:].max()))


def _aligned(remnant: Particles) -> Particles:
    """The remnant with its longest, intermediate and shortest axis along x, y and z."""
    centre = np.average(remnant.position, axis=0, weights=remnant.mass)
    directions = ellipsoid_of(remnant.position, remnant.mass).directions
    return replace(remnant, position=np.einsum("pi,ai->pa", remnant.position - centre, directions))


def _views(remnant: Particles, pixel: float) -> Views:
    along, across, up = remnant.position.T
    flat = np.stack([along, across, up], axis=1)
    edge = np.stack([along, up, -across], axis=1)
    return Views(*(picture(view, remnant.body, remnant.spacing, pixel) for view in (flat, edge)))
