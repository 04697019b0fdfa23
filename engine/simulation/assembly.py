"""Build the laws, the gravity and the walls that a scene's physics names.

For physics that a scene leaves out a null part is built, without fields and without effect.
"""

from engine.gravity.barnes_hut import BarnesHut
from engine.gravity.direct_sum import DirectSum
from engine.gravity.interfaces import GravityField
from engine.gravity.uniform import NoGravity, UniformGravity
from engine.laws.algebraic import Algebraic
from engine.laws.constitution import Constitution
from engine.laws.damage import Damage, Intact
from engine.laws.dissipation import Dissipation, NoDissipation
from engine.laws.energy import InternalEnergy, NoInternalEnergy
from engine.laws.fracture import Fracture, Unbreakable
from engine.laws.interfaces import DamageLaw, DissipationLaw, EquationOfStateLaw, PackingLaw, ShearLaw
from engine.laws.packing import AsDenseAsRock, CriticalState
from engine.laws.shear import Fluid, Hencky
from engine.laws.strength import Strength, Unlimited
from engine.laws.tillotson import ColdTillotson, Tillotson
from engine.laws.viscosity import Inviscid, Viscosity
from engine.mpm.apic import Apic
from engine.mpm.contact import GeometricContact, SharedNodes
from engine.mpm.filtered import Filtered
from engine.mpm.interfaces import Boundary, ContactLaw, Scheme
from engine.mpm.response import Response
from engine.mpm.walls import NoWalls, Walls
from engine.scene.scene import Scene
from engine.scene.tillotson import TillotsonParameters
from engine.simulation.bounds import speed_of_motion
from engine.simulation.initial_conditions import all_flaws
from engine.simulation.ledger import Ledger
from engine.state.particles import Particles


def constitution(scene: Scene, particles: Particles) -> Constitution:
    """Return the laws of matter.

    Args:
        scene: its physics and materials.
        particles: fields in which the laws keep their state.
    """
    physics, packing = scene.physics, _packing(scene, particles)
    return Constitution(
        particles,
        _equation_of_state(scene),
        InternalEnergy(particles, scene.numerics.transfer_heat) if physics.energy else NoInternalEnergy(),
        _dissipation(scene, particles),
        packing,
        _shear(scene, particles, packing),
        _damage(scene, particles),
        Viscosity(physics.viscosity, scene.dx) if physics.viscosity else Inviscid(),
    )


STILL = 1e-9
"""Speed of motion over that of waves below which bodies do not meet."""


def gravity(scene: Scene, particles: Particles) -> GravityField:
    """Return self-gravity by a tree, by the sum over all pairs at opening angle 0, uniform gravity, or none.

    Args:
        scene: its physics and particle spacing.
        particles: field in which self-gravity keeps the acceleration.
    """
    physics = scene.physics
    if physics.gravity:
        radius, opening = physics.gravity.softening * scene.spacing, physics.gravity.opening
        return BarnesHut(particles, radius, opening) if opening > 0.0 else DirectSum(particles, radius)
    return UniformGravity(physics.uniform_gravity) if physics.uniform_gravity else NoGravity()


def walls(scene: Scene) -> Boundary:
    """Return the rigid planes of a scene."""
    return Walls(scene.physics.walls) if scene.physics.walls else NoWalls()


def contact(scene: Scene) -> ContactLaw:
    """Return where bodies touch."""
    if scene.separates_bodies and scene.physics.contact:
        return GeometricContact(scene.materials, scene.dx, scene.physics.contact.gap)
    return SharedNodes()


def scheme(scene: Scene, response: Response) -> Scheme:
    """Return what particles exchange with the grid.

    Args:
        scene: its numerics, materials and walls.
        response: of one particle.
    """
    if scene.numerics.transfer == "apic":
        return Apic(response)
    motion, physics = speed_of_motion(scene), scene.physics
    waves = max(material.longitudinal_speed for material in scene.materials)
    rate = (waves + motion) / (scene.numerics.filter_time * scene.dx)
    known = motion > STILL * waves and not physics.walls and not physics.uniform_gravity
    return Filtered(response, rate, min(motion / scene.dx, rate) if known else rate, walled=bool(physics.walls))


def ledger(scene: Scene, particles: Particles, gravity: GravityField, scheme: Scheme) -> Ledger:
    """Return the sums over all particles."""
    materials, inertia = [body.material for body in scene.bodies], scheme.inertia(scene.dx)
    return Ledger(particles, materials, gravity, inertia, scene.numerics.transfer_heat)


def _equation_of_state(scene: Scene) -> EquationOfStateLaw:
    """Law of the form that all bodies have; Tillotson's on the cold curve if no internal energy is computed."""
    materials = scene.materials
    eos = materials[0].eos
    if isinstance(eos, TillotsonParameters):
        return Tillotson(materials) if scene.physics.energy else ColdTillotson(materials)
    return Algebraic(eos.formula, materials)


def _dissipation(scene: Scene, particles: Particles) -> DissipationLaw:
    """Account of what internal energy takes up, by the causes that the scene has, or none."""
    physics, filtered = scene.physics, scene.numerics.transfer == "filtered"
    if not physics.energy:
        return NoDissipation()
    return Dissipation(particles, filtered, physics.strength, physics.viscosity is not None)


def _packing(scene: Scene, particles: Particles) -> PackingLaw:
    """Dilatancy of rubble where a material has a critical density, or none."""
    loosens = scene.physics.strength and any(material.critical_density for material in scene.materials)
    return CriticalState(particles, scene.materials) if loosens else AsDenseAsRock()


def _shear(scene: Scene, particles: Particles, packing: PackingLaw) -> ShearLaw:
    """Hencky's law with or without strength, or none."""
    if not scene.physics.shear:
        return Fluid()
    strength = Strength(scene.materials, packing) if scene.physics.strength else Unlimited()
    return Hencky(particles, strength, packing, scene.materials)


def _damage(scene: Scene, particles: Particles) -> DamageLaw:
    """Damage with growth, constant damage, or none."""
    rule = scene.physics.fracture
    if rule:
        return Damage(particles, Fracture(scene.bodies, rule, all_flaws(scene)))
    return Damage(particles, Unbreakable()) if any(body.damage for body in scene.bodies) else Intact()
