"""The matrix of stiff and extreme cases."""

from dataclasses import replace

from engine.scene.bodies import Sphere
from engine.scene.scene import Gravity, Physics, Scene, ViscosityCoefficients
from engine.verification.harness import altered
from engine.verification.problems.materials import elastic
from engine.verification.stability import states
from engine.verification.stability.case import (
    ExtremeCase,
    alone,
    impact,
    in_single_precision,
    stiffened,
    with_courant_number,
    with_materials,
    with_rows,
)

RUBBLE = Physics(fracture=None)
FREE = Physics(gravity=None)
LOOSE = Physics(fracture=None, gravity=None)
SHOCK = ViscosityCoefficients(shock_linear=0.5, shock_quadratic=1.5)
FLUID = Physics(shear=False, strength=False, fracture=None, gravity=None)


def broken(scene: Scene) -> Scene:
    """Return the scene with bodies of rubble."""
    bodies = tuple(body.model_copy(update={"damage": 1.0}) for body in scene.bodies)
    return altered(scene.model_copy(update={"bodies": bodies}), "physics.fracture", None)


def loosening(velocity: float = 200.0) -> Scene:
    """Return a collision [m/s] of rock that loosens as it shears once it is broken."""
    basalt = {"critical_density": 2000.0, "dilatancy": 0.177, "crushing_pressure": 1e7}
    return impact(velocity, parameter_set="rubble", materials={"basalt": basalt}, contact=False)


def pair(velocity: tuple[float, float, float]) -> Scene:
    """Return a scene of two bodies of one particle, of which the second moves [m/s]."""
    one = Sphere(radius=50e3, particles=1, hydrostatic=False)
    return with_rows(Scene(bodies=(one, one.model_copy(update={"velocity": velocity})), end_time=500.0, physics=LOOSE))


def _time_steps() -> list[ExtremeCase]:
    """Every Courant number that a scene accepts must run; 5 is eight times the default."""
    numbers = (0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0, 1.1, 1.2, 1.3, 1.5, 2.0, 5.0)
    return [
        ExtremeCase("Courant number", f"{cfl:g}", with_courant_number(impact(), cfl), physical=cfl <= 1.0)
        for cfl in numbers
    ] + [ExtremeCase("Courant number", "5, at rest", with_courant_number(alone(hydrostatic=True), 5.0), physical=False)]


def _materials() -> list[ExtremeCase]:
    factors = (1e-3, 1e-2, 0.1, 10.0, 100.0, 1e3)
    moduli = [
        ExtremeCase(
            "moduli", f"x {factor:g}", with_materials(impact(fraction=0.5), stiffened(factor), stiffened(factor))
        )
        for factor in factors
    ]
    pairs = ((1.0, 1e-4), (1e-4, 1.0), (100.0, 0.01))
    contrasts = [
        ExtremeCase("contrast", f"{a:g} on {b:g}", with_materials(impact(fraction=0.5), stiffened(b), stiffened(a)))
        for a, b in pairs
    ]
    frictions = [
        ExtremeCase("friction", f"{mu:g}", broken(impact(materials={"basalt": {"friction": mu}})))
        for mu in (0.0, 2.0, 100.0)
    ]
    laws = [
        ExtremeCase(
            "friction", f"{law}, {mu:g}", broken(impact(materials={"basalt": {"friction": mu, "friction_law": law}}))
        )
        for law in ("mohr-coulomb", "matsuoka-nakai")
        for mu in (0.0, 1.7)
    ]
    return moduli + contrasts + frictions + laws


def _impacts() -> list[ExtremeCase]:
    speeds = (1.0, 10.0, 50.0, 1e3, 5e3, 1e4, 2e4)
    by_speed = [ExtremeCase("speed", f"{v:g} m/s", impact(velocity=v)) for v in speeds]
    head_on = [ExtremeCase("head-on", f"{v:g} m/s", impact(velocity=v, angle=0.0)) for v in (5e3, 2e4)]
    fine = {"velocity": 2e4, "particles": 300}
    finer = [ExtremeCase("speed", f"20000 m/s, 2 x 300, seed {seed}", impact(**fine, seed=seed)) for seed in (2, 3)]
    angles = [ExtremeCase("angle", f"{angle:g} deg", impact(angle=angle)) for angle in (0.0, 45.0, 80.0, 89.9)]
    small = {"radius": 5e3}
    ratios = [
        ExtremeCase("mass ratio", f"1:1000 at {v:g} m/s", impact(v, fraction=0.1, particles=1000, projectile=small))
        for v in (200.0, 5e3)
    ]
    ratios.append(ExtremeCase("mass ratio", "1:8", impact(projectile={"radius": 25e3})))
    sizes = [
        ExtremeCase("radius", "100 m", impact(radius=100.0)),
        ExtremeCase("radius", "10 km", impact(radius=10e3)),
        ExtremeCase("radius", "500 km", impact(radius=500e3, velocity=1000.0)),
        ExtremeCase("radius", "1000 km", impact(radius=1000e3, velocity=2000.0)),
    ]
    return by_speed + finer + head_on + angles + ratios + sizes


def _states() -> list[ExtremeCase]:
    return [*_compressed(), *_stretched(), *_hot(), *_spinning()]


def _compressed() -> list[ExtremeCase]:
    return [
        ExtremeCase("compressed", f"rho/rho0 = {eta:g}", alone(100.0, physics=FREE), states.strained(eta))
        for eta in (1.1, 1.5, 2.0)
    ]


def _stretched() -> list[ExtremeCase]:
    def pulled(J: float, D: float, physical: bool = True) -> ExtremeCase:
        scene = alone(100.0, physics=FREE, damage=D)
        return ExtremeCase("stretched", f"J = {J:g}, D = {D:g}", scene, states.strained(1.0 / J, D), physical)

    # at J = 50 intact rock would need more than the energy of evaporation: no state of matter
    uniform_strain = [
        pulled(1.5, 0.0),
        pulled(1.5, 1.0),
        pulled(5.0, 0.0),
        pulled(5.0, 1.0),
        pulled(50.0, 0.0, physical=False),
        pulled(50.0, 1.0),
    ]
    return uniform_strain + [
        ExtremeCase(
            "stretched", f"apart at {rate * 50e3:g} m/s", alone(2.7 / rate, physics=FREE), states.expanding(rate)
        )
        for rate in (2e-3, 2e-2, 0.2)
    ]


def _hot() -> list[ExtremeCase]:
    energies = (0.0, 1e6, 1e7, 2e7, 1e8, 1e9)
    everywhere = [ExtremeCase("hot", f"E = {E:g} J/kg", alone(100.0, physics=FREE), states.hot(E)) for E in energies]
    return [*everywhere, ExtremeCase("hot", "one particle, 1e8 J/kg", alone(100.0, physics=FREE), states.one_hot(1e8))]


def _spinning() -> list[ExtremeCase]:
    break_up = 8.69e-4  # sqrt(4 pi G rho / 3)
    return [
        ExtremeCase(
            "spin", f"{factor:g} x break-up, D = {D:g}", alone(2000.0, spin=(0.0, 0.0, factor * break_up), damage=D)
        )
        for factor, D in ((1.0, 0.0), (1.0, 1.0), (3.0, 1.0), (10.0, 0.0))
    ]


def _few() -> list[ExtremeCase]:
    pairs = [ExtremeCase("particles", f"2 x {n}", impact(particles=n)) for n in (1, 2, 10)]
    return pairs + [ExtremeCase("particles", str(n), alone(particles=n, hydrostatic=True)) for n in (1, 2, 10)]


def _positions() -> list[ExtremeCase]:
    return [
        ExtremeCase("position", "all in one point", alone(), states.coincident(1), physical=False),
        ExtremeCase("position", "all in two points", alone(), states.coincident(2), physical=False),
        ExtremeCase("position", "two in one point", alone(particles=2), states.coincident(1), physical=False),
        ExtremeCase("position", "a node of weight 1e-15", pair((0.0, 0.0, 0.0)), states.barely_touching),
        ExtremeCase("position", "1e8 m away", impact(fraction=0.2), states.distant(1e8)),
        ExtremeCase("position", "leaves the grid's range", pair((2e4, 0.0, 0.0)), states.near_the_edge, physical=False),
    ]


def _parts() -> list[ExtremeCase]:
    return [
        ExtremeCase("parts", "damage 1 everywhere", broken(impact())),
        ExtremeCase("parts", "without energy", impact().model_copy(update={"physics": Physics(energy=False)})),
        ExtremeCase("parts", "fluid", impact().model_copy(update={"physics": FLUID})),
        ExtremeCase("parts", "set talk", impact(parameter_set="talk")),
        ExtremeCase("parts", "set rubble", impact(parameter_set="rubble")),
        ExtremeCase("parts", "rubble that loosens", broken(loosening())),
        ExtremeCase("parts", "rubble that loosens, 5 km/s", loosening(5e3)),
        ExtremeCase("parts", "bodies share nodes", impact(contact=False)),
        ExtremeCase("parts", "bodies share nodes, 5 km/s", impact(5e3, contact=False)),
        ExtremeCase("parts", "viscosity 3e5 m2/s", impact(viscosity=ViscosityCoefficients(shear=3e5))),
        ExtremeCase("parts", "shock viscosity, 5 km/s", impact(5e3, viscosity=SHOCK)),
        ExtremeCase("parts", "sound speed x 0.1, 10 m/s", impact(10.0, sound_speed=0.1)),
    ]


def _flows() -> list[ExtremeCase]:
    soft = elastic(2700.0, 1.0, 1.0)
    gravity = Gravity(softening=0.3, interval=1.0, opening=0.3)
    pressureless = Physics(shear=False, strength=False, fracture=None, gravity=gravity)
    return [
        ExtremeCase(
            "flow", "rubble expands to J = 50", alone(1350.0, physics=LOOSE, damage=1.0), states.expanding(2e-3)
        ),
        ExtremeCase("flow", "rubble flows together", alone(500.0, physics=LOOSE, damage=1.0), states.expanding(-2e-3)),
        # in the point the density is infinite
        ExtremeCase(
            "flow",
            "dust falls through a point",
            alone(2000.0, physics=pressureless, material=soft, damage=1.0),
            physical=False,
        ),
        ExtremeCase("flow", "rubble in random motion", alone(500.0, physics=RUBBLE), states.random_motion(100.0, 1e-2)),
        ExtremeCase(
            "flow", "violent random motion", alone(50.0, physics=LOOSE), states.random_motion(5e3, 1.0), physical=False
        ),
    ]


def _single_precision() -> list[ExtremeCase]:
    hot = alone(100.0, physics=FREE)
    cases = [
        ExtremeCase("f32", "200 m/s", impact()),
        ExtremeCase("f32", "20000 m/s", impact(velocity=2e4)),
        ExtremeCase("f32", "radius 100 m", impact(radius=100.0)),
        ExtremeCase("f32", "moduli x 1000", with_materials(impact(fraction=0.5), stiffened(1e3), stiffened(1e3))),
        ExtremeCase("f32", "at rest", alone(hydrostatic=True)),
        ExtremeCase("f32", "E = 1e+08 J/kg", hot, states.hot(1e8)),
        ExtremeCase("f32", "1e8 m away", impact(fraction=0.2), states.distant(1e8)),
        ExtremeCase("f32", "Courant number 5", with_courant_number(impact(), 5.0), physical=False),
    ]
    return [replace(case, scene=in_single_precision(case.scene)) for case in cases]


def all_cases() -> list[ExtremeCase]:
    """Return every case, group by group."""
    groups = (_time_steps, _materials, _impacts, _states, _few, _positions, _parts, _flows, _single_precision)
    return [case for group in groups for case in group()]
