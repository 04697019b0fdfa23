"""What a simulation asks of a gravity: accelerations on the device, energy on the host."""

from typing import Protocol

from engine.arrays import Vector


class GravityField(Protocol):
    """Acceleration of particles by gravity: `SelfGravity`, `UniformGravity` or `NoGravity`."""

    def at(self, p):
        """Return the acceleration of particle p [m/s^2].

        A device function. The transfer scheme calls it in every step, for the momentum and for the limits of the time
        step.
        """

    def energy(self, moment: Vector) -> float:
        """Return the potential energy [J] of all particles where they are now.

        Called on the host between steps, for the conserved quantities.

        Args:
            moment: sum of mass times position [kg m], shape [3].
        """
