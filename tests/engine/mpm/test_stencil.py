"""Nodes in memory: sums over the copies of blocks, positions of nodes, and the margin of a block."""

import numpy as np
import pytest
import taichi as ti

from engine.device.backend import vec4
from engine.mpm.spline import spline_weights
from engine.mpm.stencil import COPY, TILE, Stencil, node_in_tile, within_margin
from engine.simulation.simulation import Simulation
from tests.helpers.device import Array, worst
from tests.helpers.scenes import body, scene, started

pytestmark = pytest.mark.usefixtures("taichi")


def cloud() -> Simulation:
    """A sphere of 200 particles over several blocks, away from the origin."""
    return started(scene(body(particles=200, position=(3e5, -2e5, 1e5))))


@ti.data_oriented
class Probe:
    """Kernels that call the device functions of a stencil, one after another."""

    def __init__(self, stencil: Stencil, count: int) -> None:
        self.stencil, self.within = stencil, ti.field(ti.i32, count)
        self.mean, self.gradient = ti.Vector.field(3, ti.f64, count), ti.Matrix.field(3, 3, ti.f64, count)

    @ti.kernel
    def check_margin(self):
        for p in self.within:
            x = self.stencil.particles.x[p] / self.stencil.dx[None]
            self.within[p] = within_margin(x, self.stencil.particles.origin[p])

    @ti.kernel
    def set_linear_field(self, slope: ti.types.matrix(3, 3, ti.f64), offset: ti.types.vector(3, ti.f64)):
        for n in range(self.stencil.site_count[None] * TILE):
            x = self.stencil.node_position(n // TILE, node_in_tile(n))
            for corner in range(8):
                b = self.stencil.source[n // TILE, corner]
                if b >= 0:
                    c, m = ti.Vector([corner >> 2, (corner >> 1) & 1, corner & 1]), n % TILE
                    i = 4 * c + ti.Vector([m // 16, (m // 4) % 4, m % 4])
                    self.stencil.nodes[b * COPY + (i[0] * 8 + i[1]) * 8 + i[2]] = vec4(slope @ x + offset, 1.0)

    @ti.kernel
    def gather(self):
        for p in self.within:
            n, f = self.stencil.locate(p, self.stencil.owner[p])
            self.mean[p], _, self.gradient[p] = self.stencil.gather(n, f, spline_weights(f))


def test_gathering_a_linear_field_gives_its_value_and_its_slope_at_the_particle():
    """Every node lies where its position says, in every copy."""
    simulation = cloud()
    slope, offset = np.random.default_rng(1).normal(size=(3, 3)), np.array([1e5, 2e5, -3e5])
    probe = Probe(simulation.stencil, simulation.particles.count)
    probe.set_linear_field(ti.Matrix(slope), ti.Vector(offset))
    probe.gather()
    x = simulation.particles.x.to_numpy()[:200]
    assert worst(probe.mean.to_numpy(), x @ slope.T + offset, 1e6) < 1e-14
    assert worst(probe.gradient.to_numpy(), np.tile(slope, (200, 1, 1)), 1.0) < 1e-10


def node_sums(simulation: Simulation) -> Array:
    """Sums of momentum and mass over all nodes of all copies, shape [4]."""
    return np.asarray(simulation.stencil.nodes.to_numpy().sum(axis=0))


def test_scattering_keeps_mass_and_momentum():
    simulation = cloud()
    v = np.random.default_rng(2).normal(size=(200, 3))
    simulation.start(v=v, C=1e-4 * np.random.default_rng(3).normal(size=(200, 3, 3)))
    simulation.clock.pause_time[None] = 1.0
    simulation.transfer.begin()
    projection = simulation.transfer.stages[2]
    projection.particles_to_grid()
    mass = simulation.particles.read("mass")["mass"]
    expected = np.array([*(mass[:, None] * v).sum(axis=0), mass.sum()])
    assert worst(node_sums(simulation)[None], expected[None], mass.sum()) < 1e-14


def margin_after(shift: Array) -> Array:
    """Whether the block of each particle still contains its nodes once all have moved by a shift, in cells."""
    simulation = cloud()
    probe = Probe(simulation.stencil, 200)
    simulation.particles.x.from_numpy(simulation.particles.x.to_numpy() + simulation.scene.dx * shift)
    probe.check_margin()
    return probe.within.to_numpy() == 1


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_particle_may_move_by_half_a_cell_in_any_direction_and_by_no_whole_block(axis, sign):
    """A half of the margin is kept for the motion within a step."""
    step = np.zeros(3)
    step[axis] = sign
    assert margin_after(0.5 * step).all()
    assert not margin_after(5.0 * step).any()
