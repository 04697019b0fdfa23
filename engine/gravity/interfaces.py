"""What a simulation asks of a gravity: accelerations on the device, energy on the host."""

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Scalars = NDArray[np.float64]
"""One number per particle, shape [particle_count]."""

Vectors = NDArray[np.float64]
"""One vector per particle, shape [particle_count, 3]."""

Indices = NDArray[np.int64]
"""Indices of particles."""


class Gravity(Protocol):
    """Acceleration of particles by gravity: `SelfGravity`, `UniformGravity` or `NoGravity`."""

    def at(self, p: Any) -> Any:
        """Return the acceleration of particle p [m/s^2].

        A device function. The transfer calls it in every step: from particles to the grid, and for ballistic particles.
        """

    def energy(self) -> float:
        """Return the potential energy [J] of the particles at their present positions.

        Called on the host between steps, for the conserved quantities.
        """
