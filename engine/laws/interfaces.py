"""Contracts of the laws: what each gives, when in a step it is called, and which state of a particle it may change.

`Constitution.update` calls them for one particle after its velocity gradient is known (g2p), in the order of this file.
All methods are device functions. `p` is the index of the particle, by which a law reads and writes state of its own;
`body` the index of its body, which fixes the material. A law that a scene leaves out has a twin without fields that
does nothing; the contract is written here once for both.
"""

from typing import Protocol


class EquationOfStateLaw(Protocol):
    """Pressure, speed of sound and reference density (engine/physics.md, section 2)."""

    def evaluate(self, p, mu, E, body):
        """Return the pressure [Pa] and the squared speed of sound [m^2/s^2].

        Args:
            p: index of the particle.
            mu: rho/rho0 - 1 [-].
            E: specific internal energy [J/kg].
            body: index of the body.
        """

    def rho0(self, body):
        """Return the density of the reference state [kg/m^3]."""


class EnergyLaw(Protocol):
    """Specific internal energy E [J/kg] (engine/physics.md, section 2)."""

    def after(self, p, work):
        """Return E of particle p after work [J/kg] that is not yet added; zero where no energy is kept."""

    def work(self, p, first_half, second_half):
        """Add work [J/kg] of stress in both halves of a step to E of particle p; called once a step."""

    def heat(self, p, heat):
        """Add what the transfer dissipates [J/kg] to E of particle p, if it is to take it up."""


class DissipationLaw(Protocol):
    """Specific energy [J/kg] that motion has lost, by cause (engine/physics.md, section 2)."""

    def transfer(self, p, heat):
        """Add what the transfer took from the motion of particle p [J/kg]."""

    def drift(self, p, loss):
        """Add what the affine motion of particle p loses as it moves [J/kg]; negative where matter flows together."""

    def stress(self, p, plastic, viscous):
        """Add what plastic and viscous flow took from the motion of particle p [J/kg]; called last in the step."""


class DamageLaw(Protocol):
    """Damage D [-] (engine/physics.md, section 5)."""

    def value(self, p):
        """Return D of particle p, 0 to 1."""

    def grow(self, p, s, P, dt, body):
        """Break particle p further; called after the stress is known.

        Args:
            p: index of the particle.
            s: deviatoric Cauchy stress [Pa].
            P: pressure [Pa].
            dt: time step [s].
            body: index of the body.
        """


class GrowthLaw(Protocol):
    """Growth of damage during a step (engine/physics.md, section 5)."""

    def grow(self, root, s, P, dt, number, body):
        """Return the cube root of D after a step; it never falls.

        Args:
            root: cube root of D before [-].
            s: deviatoric Cauchy stress [Pa].
            P: pressure [Pa].
            dt: time step [s].
            number: of the particle in the scene, which does not change when particles are sorted.
            body: index of the body.
        """


class ShearLaw(Protocol):
    """Deviatoric stress, limited by a strength (engine/physics.md, sections 3 and 4)."""

    def stress(self, p, H, growth, J, P, E, D, body):
        """Return the deviatoric Kirchhoff stress [Pa] and store the elastic strain of particle p.

        Args:
            p: index of the particle.
            H: displacement gradient dt L of the step [-].
            growth: det(I + H) - 1 [-].
            J: rho0/rho after the step [-].
            P: pressure [Pa].
            E: specific internal energy [J/kg].
            D: damage [-].
            body: index of the body.
        """

    def modulus(self, body):
        """Return the shear modulus [Pa]; zero where there is no shear stress."""

    def elastic_energy(self, s, body):
        """Return the energy [J/m^3] that a deviatoric Kirchhoff stress s [Pa] stores in a reference volume."""


class StrengthLaw(Protocol):
    """Largest shear stress (engine/physics.md, section 4)."""

    def bears_shear(self, P, D):
        """Return whether there may be any shear stress at a pressure [Pa] and a damage [-]."""

    def limit(self, p, P, E, D, s, body):
        """Return the largest sqrt(J2) [Pa]; infinite where nothing limits it.

        Args:
            p: index of the particle.
            P: pressure [Pa], positive in compression.
            E: specific internal energy [J/kg].
            D: damage [-].
            s: direction of the deviatoric stress, of any size, positive in tension.
            body: index of the body.
        """


class PackingLaw(Protocol):
    """How loosely broken rock is packed (engine/physics.md, section 4)."""

    def dilation(self, p):
        """Return J_c - 1 [-], with the J_c = rho0/rho above which particle p bears no pressure once it is broken."""

    def friction(self, p, mu, P, body):
        """Return the friction coefficient [-] in triaxial compression of particle p.

        Args:
            p: index of the particle.
            mu: that of the densest packing [-].
            P: pressure [Pa].
            body: index of the body.
        """

    def shear(self, p, shear, J, P, Y, D, body):
        """Change the packing of particle p; called after its strength has limited the stress.

        Args:
            p: index of the particle.
            shear: plastic shear sqrt(2 e:e) of the step, of the plastic strain e [-].
            J: rho0/rho after the step [-].
            P: pressure [Pa].
            Y: largest sqrt(J2) [Pa].
            D: damage [-].
            body: index of the body.
        """


class FrictionLaw(Protocol):
    """Friction of damaged rock (engine/physics.md, section 4)."""

    def coefficient(self, mu, s):
        """Return the largest sqrt(J2)/P [-].

        Args:
            mu: that in triaxial compression [-].
            s: direction of the deviatoric stress, of any size, positive in tension.
        """


class ViscosityLaw(Protocol):
    """Viscous stress (engine/physics.md, section 6)."""

    def stress(self, p, d, rho, c):
        """Return the viscous Cauchy stress [Pa], positive in tension, and the diffusivity [m^2/s].

        Args:
            p: index of the particle.
            d: symmetric velocity gradient [1/s].
            rho: density [kg/m^3].
            c: speed of sound [m/s].
        """
