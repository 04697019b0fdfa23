"""Response of one particle to one step of deformation, from all laws (engine/physics.md, sections 1 to 6).

Every particle stores j = det F - 1 and the Kirchhoff stress tau = J sigma; laws store state of their own beside them.
"""

import taichi as ti

from engine.device.tensors import determinant_increment, deviator, identity, pack, symmetric, unpack
from engine.laws.interfaces import (
    DamageLaw,
    DissipationLaw,
    EnergyLaw,
    EquationOfStateLaw,
    PackingLaw,
    ShearLaw,
    ViscosityLaw,
)
from engine.state.particles import Particles


@ti.func
def strain_increment(H):
    """Return the logarithmic strain sym(ln(I + H)) of a step to second order, sym(H - H^2/2).

    To first order a rigid rotation would strain matter, and a spinning body would lose internal energy.

    Args:
        H: displacement gradient dt L of the step [-].
    """
    return symmetric(H - 0.5 * (H @ H))


@ti.data_oriented
class Constitution:
    """Stress, energy and damage of one particle.

    Args:
        particles: state of the particles.
        eos: equation of state, which also has the reference density.
        energy: internal energy.
        dissipation: account of what becomes heat.
        packing: of broken rock.
        shear: shear stress, with its strength.
        damage: damage, with its growth.
        viscosity: viscous stress.
    """

    def __init__(
        self,
        particles: Particles,
        eos: EquationOfStateLaw,
        energy: EnergyLaw,
        dissipation: DissipationLaw,
        packing: PackingLaw,
        shear: ShearLaw,
        damage: DamageLaw,
        viscosity: ViscosityLaw,
    ) -> None:
        self.particles, self.eos, self.energy, self.dissipation = particles, eos, energy, dissipation
        self.packing, self.shear, self.damage, self.viscosity = packing, shear, damage, viscosity

    @ti.func
    def update(self, p, L, dt):
        """Advance strain, energy, damage and stress of particle p over one step.

        Called once a step and particle, from grid to particles. Changes j, tau and the state of the laws of particle p
        alone.

        Args:
            p: index of the particle.
            L: velocity gradient [1/s].
            dt: time step [s].

        Returns:
            Signal speed [m/s] and diffusivity of momentum [m^2/s].
        """
        body = self.particles.body[p]
        rho0, H = self.eos.rho0(body), dt * L
        growth, strain = determinant_increment(H), strain_increment(H)
        j = self.particles.j[p] + (1.0 + self.particles.j[p]) * growth
        before = unpack(self.particles.tau[p])
        half_work = 0.5 / rho0 * ddot(before, strain)
        E, D = self.energy.after(p, 2.0 * half_work), self.damage.value(p)
        J, dilation = 1.0 + j, self.packing.dilation(p)
        P, c2 = self.evaluate(p, j, E, body)
        if P < 0.0:
            P *= 1.0 - D
        s = self.shear.stress(p, H, growth, J, P, E, D, body)
        stress, diffusivity = self.viscosity.stress(p, symmetric(L), rho0 / J, ti.sqrt(c2))
        tau = s + J * (stress - P * identity())
        self.particles.j[p], self.particles.tau[p] = j, pack(tau)
        # trapezoidal rule: the work of the mean stress, so that elastic energy does not drift
        self.energy.work(p, half_work, 0.5 / rho0 * ddot(tau, strain))
        self.dissipate(p, before, tau, J * stress, strain, P * (self.packing.dilation(p) - dilation))
        self.damage.grow(p, s / J, P, dt, body)
        return self.signal_speed_of(c2, body), diffusivity

    @ti.func
    def dissipate(self, p, before, after, viscous, strain, lifted):
        """Account for the work of shear stress that elastic strain does not store, and for that of viscous stress.

        Args:
            p: index of the particle.
            before, after: Kirchhoff stress before and after the step [Pa].
            viscous: viscous part of that after it [Pa].
            strain: logarithmic strain of the step [-].
            lifted: work of dilatancy against pressure [J/m^3], which it takes from that of shear.
        """
        body = self.particles.body[p]
        s0, s = deviator(before), deviator(after)
        stored = self.shear.elastic_energy(s, body) - self.shear.elastic_energy(s0, body)
        work = ddot(0.5 * (s0 + s) - deviator(viscous), strain)
        rho0 = self.eos.rho0(body)
        self.dissipation.stress(p, (work - stored - lifted) / rho0, ddot(viscous, strain) / rho0)

    @ti.func
    def rest(self, p):
        """Leave particle p undeformed for a step."""
        self.energy.work(p, 0.0, 0.0)

    @ti.func
    def lose_to_transfer(self, p, heat):
        """Give particle p the energy [J/kg] that the transfer takes from its motion."""
        self.energy.heat(p, heat)
        self.dissipation.transfer(p, heat)

    @ti.func
    def rho0(self, p):
        """Return the density of the reference state [kg/m^3] of particle p."""
        return self.eos.rho0(self.particles.body[p])

    @ti.func
    def signal_speed(self, p):
        """Return the signal speed [m/s] in the present state of particle p."""
        body = self.particles.body[p]
        _, c2 = self.evaluate(p, self.particles.j[p], self.energy.after(p, 0.0), body)
        return self.signal_speed_of(c2, body)

    @ti.func
    def evaluate(self, p, j, E, body):
        """Return the pressure [Pa], and a bound of the squared speed of sound [m^2/s^2], J_c^2 c^2 of loose rubble."""
        dilation = self.packing.dilation(p)
        P, c2 = self.eos.evaluate(p, (dilation - j) / (1.0 + j), E, body)
        return P, c2 * (1.0 + dilation) ** 2

    @ti.func
    def expansion(self, p):
        """Return J/J_c - 1 [-] of particle p: above zero broken rock bears no pressure."""
        dilation = self.packing.dilation(p)
        return (self.particles.j[p] - dilation) / (1.0 + dilation)

    @ti.func
    def signal_speed_of(self, c2, body):
        """Return the signal speed sqrt(max(3 c^2, 2 G/rho0)) [m/s].

        Particles oscillate with at most twice this over dx, however they lie (engine/physics.md, section 1).

        Args:
            c2: squared speed of sound of the equation of state [m^2/s^2].
            body: index of the body.
        """
        return ti.sqrt(ti.max(3.0 * c2, 2.0 * self.shear.modulus(body) / self.eos.rho0(body)))


@ti.func
def ddot(S, T):
    """Return S : T of two symmetric tensors."""
    return (
        S[0, 0] * T[0, 0]
        + S[1, 1] * T[1, 1]
        + S[2, 2] * T[2, 2]
        + 2.0 * (S[0, 1] * T[0, 1] + S[0, 2] * T[0, 2] + S[1, 2] * T[1, 2])
    )
