"""Lobes of a remnant: maxima of its mass per length along the longest axis."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.signal import find_peaks

from analysis.remnant.particles import Array

NECK = 0.3
"""A neck between lobes has less mass per length than the lower of both maxima by at least this fraction of it."""

SMOOTHING = 1.0
"""Standard deviation of the smoothing along the axis, in particle spacings h: a layer of particles is no lobe."""

BINS = 4
"""Bins of the profile per particle spacing."""


@dataclass(frozen=True)
class Lobes:
    """Parts of a remnant between its necks.

    Attributes:
        mass: of each lobe, largest first [kg], shape [lobe_count].
    """

    mass: Array

    @property
    def count(self) -> int:
        """Number of lobes; 1 of a body without neck."""
        return len(self.mass)


def lobes_of(position: Array, mass: Array, direction: Array, spacing: float) -> Lobes:
    """Cut a clump where its mass per length along an axis has a neck.

    Args:
        position: [m], shape [particle_count, 3].
        mass: [kg], shape [particle_count].
        direction: unit vector along the axis, shape [3].
        spacing: particle spacing h [m].
    """
    along = (position - position.mean(axis=0)) @ direction
    margin = 5.0 * SMOOTHING * spacing
    edges = np.arange(along.min() - margin, along.max() + margin, spacing / BINS)
    profile = gaussian_filter1d(np.histogram(along, edges, weights=mass)[0], SMOOTHING * BINS)
    peaks = _peaks(profile)
    necks = [first + int(np.argmin(profile[first:last])) for first, last in pairwise(peaks)]
    lobe = np.searchsorted(edges[necks], along)
    total = np.bincount(lobe, weights=mass, minlength=len(necks) + 1).astype(np.float64)
    return Lobes(np.sort(total)[::-1])


def _peaks(profile: Array) -> list[int]:
    """Maxima of a profile that is 0 at both ends; of two without a neck between them the higher."""
    peaks = [int(peak) for peak in find_peaks(profile)[0]]
    while len(peaks) > 1:
        necks = [_neck(profile, *pair) for pair in pairwise(peaks)]
        shallowest = int(np.argmin(necks))
        if necks[shallowest] >= NECK:
            break
        peaks.remove(min(peaks[shallowest : shallowest + 2], key=lambda peak: profile[peak]))
    return peaks


def _neck(profile: Array, first: int, last: int) -> float:
    """By which fraction of the lower of two maxima the profile falls between them."""
    return float(1.0 - profile[first:last].min() / min(profile[first], profile[last]))
