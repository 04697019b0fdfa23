"""Largest stable time step of the linear scheme: theory, and the engine's own by bisection.

Elastic waves on a periodic block of equal particles. With the operators of section 1 of engine/physics.md (T takes
velocities from the grid to particles and back, D gives velocity gradients of particles from the grid) the part a of
the motion that forces f over mass have set, q = gather(a), changes in a step by

    a' = a - dt f,    f' = f + dt K T a',    a'' = (1 - kappa (1 - T)^2) a',

K = M^-1 sum_p V D^T (lambda tr + 2 mu sym) D. For a wave of one wave number the eigenvalues z obey
z^2 - (1 + phi - dt^2 K T) z + phi = 0 with phi = 1 - kappa (1 - T)^2, so both stay within the unit circle if and only
if dt^2 K T <= 2 (1 + phi). Without the filter, phi = 1, this is dt <= 2/omega.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.errors import GuardFault
from engine.scene.bodies import Box
from engine.scene.material import named
from engine.scene.scene import Numerics, Physics, Scene
from engine.verification.harness import Array, Harness, altered

CELLS = 4
"""Edge of the periodic block: waves of one to four cells, the shortest among them."""

START = 1e-6
"""Speed [m/s] of the random motion that must not grow."""

ROUNDING = 1e-5
"""Excess of the spectral radius over one that is round-off: rigid motion is a double eigenvalue."""


@dataclass(frozen=True)
class Limit:
    """The largest stable time step of one block.

    Attributes:
        block: particles of a cell along its edges.
        measured: c dt/dx in the engine [-].
        theory: c dt/dx of the matrix of a step [-].
    """

    block: str
    measured: float
    theory: float


@dataclass(frozen=True)
class Block:
    """A periodic block of elastic basalt.

    Attributes:
        lattice: particles along its edges.
        steps: time steps in which an unstable wave must show.
    """

    lattice: tuple[int, int, int]
    steps: int = 300

    @property
    def name(self) -> str:
        """Particles of a cell along its edges."""
        return " x ".join(f"{n / CELLS:g}" for n in self.lattice)

    def scene(self, courant: float) -> Scene:
        """Return the block at steps of c dt/dx with the longitudinal speed c, also ones that validation refuses."""
        edge = float(CELLS)
        per_cell = float(np.prod(self.lattice)) / CELLS**3
        physics = Physics(strength=False, fracture=None, gravity=None)
        box = Box(size=(edge,) * 3, lattice=self.lattice, position=(0.5 * edge,) * 3)
        numerics = Numerics(particles_per_cell=per_cell)
        scene = Scene(bodies=(box,), period=(edge,) * 3, end_time=1e6, physics=physics, numerics=numerics)
        rock = box.material
        return altered(scene, "numerics.cfl", courant * rock.signal_speed / rock.longitudinal_speed)

    def limit(self) -> Limit:
        """Return both limits; Taichi must have been started."""
        return Limit(self.name, self.measured(), self.theory())

    def theory(self) -> float:
        """Return the largest stable c dt/dx of the matrix of a step."""
        T, K = self._operators()
        return bisect(lambda courant: spectral_radius(T, K, courant) <= 1.0 + ROUNDING)

    def measured(self) -> float:
        """Return the largest c dt/dx at which random motion of 1e-9 of the wave speed does not grow in the engine."""
        return bisect(self.decays)

    def decays(self, courant: float) -> bool:
        """Return whether random motion does not grow in the engine at steps of c dt/dx."""
        generator, count = np.random.default_rng(1), int(np.prod(self.lattice))
        simulation = Harness().start(self.scene(courant), v=START * generator.normal(size=(count, 3)))
        try:
            while simulation.step < self.steps:
                simulation.advance(simulation.scene.end_time)
        except GuardFault:
            return False
        state = simulation.particles.read("v", "C")  # one cell is a metre
        return bool(max(np.abs(state["v"]).max(), np.abs(state["C"]).max()) < 100.0 * START)

    def _operators(self) -> tuple[Array, Array]:
        """T and K on the velocities of all nodes, in units of dx and of the longitudinal speed."""
        W, D = self._weights()
        mass = W.sum(axis=0)
        T = (W.T @ W + 0.25 * np.einsum("pai,paj->ij", D, D)) / mass[:, None]
        K = _stiffness(D) / np.tile(mass, 3)[:, None]
        return np.kron(np.eye(3), T), K

    def _weights(self) -> tuple[Array, Array]:
        """Spline weights, shape [particle, node], and (4/dx) w (x_i - x_p)/dx, shape [particle, 3, node]."""
        axes = [(np.arange(n) + 0.5) * CELLS / n for n in self.lattice]
        x = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
        nodes = np.stack(np.meshgrid(*[np.arange(CELLS)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
        offset = (nodes[None] - x[:, None] + 0.5 * CELLS) % CELLS - 0.5 * CELLS
        distance = np.abs(offset)
        spline = np.where(distance < 0.5, 0.75 - distance**2, 0.5 * np.maximum(1.5 - distance, 0.0) ** 2)
        W = spline.prod(axis=2)
        return W, 4.0 * np.einsum("pi,pia->pai", W, offset)


def spectral_radius(T: Array, K: Array, courant: float) -> float:
    """Return the largest growth of any wave in a step of c dt/dx: the spectral radius of its matrix."""
    unit, dt = np.eye(len(K)), courant
    kept = unit - min(1.0, dt / Numerics().filter_time) * (unit - T) @ (unit - T)
    step = np.block([[kept, -dt * kept], [dt * K @ T, unit - dt**2 * K @ T]])
    return float(np.abs(np.linalg.eigvals(step)).max())


def _stiffness(D: Array) -> Array:
    """sum_p D^T (lambda tr + 2 mu sym) D with lambda + 2 mu = 1, shape [3 nodes, 3 nodes]."""
    rock = named("basalt")
    mu = rock.shear_modulus / rock.longitudinal_modulus
    nodes = D.shape[2]
    K = np.empty((3, nodes, 3, nodes))
    products = np.einsum("pai,pbj->abij", D, D)
    trace = products[0, 0] + products[1, 1] + products[2, 2]
    for a in range(3):
        for b in range(3):
            # d sigma_a. / d v_b: lambda D_a D_b + mu (D_b D_a + delta_ab D.D)
            K[a, :, b, :] = (1.0 - 2.0 * mu) * products[a, b] + mu * products[b, a] + mu * (a == b) * trace
    return K.reshape(3 * nodes, 3 * nodes)


def bisect(condition: Callable[[float], bool], low: float = 0.5, high: float = 2.0, digits: float = 2e-3) -> float:
    """Return the largest value at which a condition is true; it must be at the lower end, and not at the upper one."""
    while high - low > digits:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if condition(middle) else (low, middle)
    return low


BLOCKS = (Block((4, 4, 4)), Block((8, 8, 4)), Block((8, 8, 8)))
