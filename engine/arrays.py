"""Types of arrays of the host, in double precision: a name says the shape."""

import numpy as np
from numpy.typing import NDArray

Scalars = NDArray[np.float64]
"""One number per particle, shape [particle_count]."""

Vectors = NDArray[np.float64]
"""One vector per particle, shape [particle_count, 3]."""

Vector = NDArray[np.float64]
"""One vector, shape [3]."""

Tensor = NDArray[np.float64]
"""One tensor, shape [3, 3]."""

Indices = NDArray[np.integer]
"""Indices of particles, shape [count]."""
