"""Names, meanings and units of what a run writes: the history, the particles, and which of it is conserved."""

from typing import NamedTuple


class Quantity(NamedTuple):
    """CF attributes of one variable.

    Attributes:
        long_name: meaning.
        units: unit, as CF writes it; empty for texts.
        comment: how it is measured, if that needs a word.
        is_vector: whether it has a component along each axis of space.
    """

    long_name: str
    units: str
    comment: str = ""
    is_vector: bool = False

    def attributes(self) -> dict[str, str]:
        """Return netCDF attributes, without those that are empty."""
        texts = {"long_name": self.long_name, "units": self.units, "comment": self.comment}
        return {key: text for key, text in texts.items() if text}

    def dims(self, along: str) -> tuple[str, ...]:
        """Return the dimensions of an array of values; the last one of a vector is `space`.

        Args:
            along: name of the first dimension.
        """
        return (along, "space") if self.is_vector else (along,)


SPACE = ("x", "y", "z")
"""Coordinates of the dimension `space` of every vector."""

HISTORY = {
    "time": Quantity("time after point-mass contact", "s"),
    "step": Quantity("time steps done", "1"),
    "dt": Quantity("time step", "s"),
    "mass": Quantity("total mass", "kg"),
    "momentum": Quantity("total momentum", "kg m s-1", is_vector=True),
    "angular_momentum": Quantity(
        "total angular momentum about the origin, affine part included", "kg m2 s-1", is_vector=True
    ),
    "kinetic_energy": Quantity("kinetic energy of the mean motion of particles", "J"),
    "affine_kinetic_energy": Quantity("kinetic energy of the motion inside particles", "J"),
    "internal_energy": Quantity("work done by stress, elastic energy included, and heat of the transfer", "J"),
    "elastic_energy": Quantity("energy stored in elastic strain, a part of internal_energy", "J"),
    "gravitational_energy": Quantity("gravitational energy", "J"),
    "half_step_work": Quantity("work in half a step: takes kinetic energy to the time of the other energies", "J"),
    "transfer_heat": Quantity("energy that motion lost to the transfer since the start", "J"),
    "plastic_heat": Quantity("energy that motion lost to plastic flow since the start", "J"),
    "viscous_heat": Quantity("energy that motion lost to viscosity since the start", "J"),
    "lost_energy": Quantity(
        "energy that affine motion lost in free motion, and transfer_heat if internal_energy does not contain it", "J"
    ),
    "total_energy": Quantity("kinetic, affine, internal and gravitational energy at one time, and lost_energy", "J"),
    "gravity_change": Quantity("relative change of gravity over the interval for which it was held", "1"),
    "gravity_force": Quantity("net force of gravity, which is taken out, over the sum of all forces", "1"),
    "gravity_torque": Quantity(
        "net torque of gravity, which is taken out, over the sum of forces times distances", "1"
    ),
    "largest_speed": Quantity("highest speed of a particle", "m s-1"),
    "largest_compression": Quantity("highest rho/rho0 of a particle", "1"),
    "damaged_fraction": Quantity("mean damage of all particles", "1"),
    "compressed_fraction": Quantity("fraction of the mass that is denser than its packing, and so bears pressure", "1"),
    "isolated": Quantity("particles with no other in their block or in one beside it", "1"),
}
"""Variables of history.nc."""

CONSERVED = ("mass", "momentum", "angular_momentum", "total_energy")
"""Variables of `HISTORY` that a closed system conserves; the total energy not with the transfer `apic`."""

HEATS = ("transfer_heat", "plastic_heat", "viscous_heat")
"""Variables of `HISTORY` that motion loses, by cause."""

PARTICLES = {
    "position": Quantity("position", "m", is_vector=True),
    "velocity": Quantity("velocity", "m s-1", is_vector=True),
    "mass": Quantity("mass", "kg"),
    "J": Quantity("volume relative to the reference state, det F", "1"),
    "rho": Quantity("density", "kg m-3"),
    "damage": Quantity("damage", "1"),
    "energy": Quantity("specific internal energy", "J kg-1"),
    "packing": Quantity("J_c, the J above which broken rock bears no pressure", "1", "absent where it is 1 everywhere"),
    "body": Quantity("index of the body the particle came from", "1"),
}
"""Variables of snapshots and of final.nc."""
