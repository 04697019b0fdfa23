"""What a simulation asks of a gravity: accelerations on the device, energy on the host."""

from typing import Protocol

from engine.arrays import Scalars, Vectors


class GravityField(Protocol):
    """Acceleration of particles by gravity: `SelfGravity`, `UniformGravity` or `NoGravity`."""

    def at(self, p):
        """Return the acceleration of particle p [m/s^2].

        A device function. The transfer scheme calls it in every step, for the momentum and for the limits of the time
        step.
        """

    def energy(self, x: Vectors, mass: Scalars) -> float:
        """Return the potential energy [J] of all particles.

        Called on the host between steps, for the conserved quantities.

        Args:
            x: positions [m], shape [particle_count, 3].
            mass: masses [kg], shape [particle_count].
        """
