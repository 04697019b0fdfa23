"""The kernels of one time step of the Material Point Method: p2g, grid update, g2p (engine/physics.md, section 1).

One pass over the tiles sums the copies of every node in a fixed order and writes the common velocity back into each. On
the CPU one thread works on one block at a time.
"""

import taichi as ti

from engine.constants import BLOCK_EDGE
from engine.device.backend import TASK, Real, vec3, vec4
from engine.mpm.interfaces import Boundary, Scheme
from engine.mpm.spline import spline_weights
from engine.mpm.stencil import COPY, TILE, Stencil, corner_coordinates, in_copy, node_in_tile
from engine.mpm.time_step import Limits, rate_of, tightest
from engine.state.clock import Clock


@ti.data_oriented
class Transfer:
    """Particles to grid and back.

    Args:
        stencil: nodes of the particles.
        scheme: what a particle gives and takes.
        walls: boundary of space.
        clock: time and time step.
        cfl: Courant number: time step in units of the time a wave needs for one cell.
    """

    def __init__(self, stencil: Stencil, scheme: Scheme, walls: Boundary, clock: Clock, cfl: float) -> None:
        self.stencil, self.scheme, self.walls, self.clock = stencil, scheme, walls, clock
        self.cfl = ti.field(Real, ())
        self.cfl[None] = cfl

    def step(self) -> None:
        """Advance all particles by one time step, unless the clock says to pause."""
        self.particles_to_grid()
        self.update_grid()
        self.grid_to_particles()

    @ti.kernel
    def particles_to_grid(self):
        """Scatter mass and momentum, with the momentum that stress adds over the step (p2g)."""
        self.clock.begin_step()
        blocks = self.stencil.block_count[None] * self.clock.running[None]
        if ti.static(not self.stencil.atomic):
            for t in range(blocks * TASK):
                if t & (TASK - 1) == 0:
                    self.scatter_block(t // TASK)
        else:
            for n in range(blocks * COPY):
                self.stencil.nodes[n] = vec4(0.0)
            for p in range(self.stencil.shared_count[None] * self.clock.running[None]):
                self.scatter(p, self.stencil.owner[p])

    @ti.kernel
    def update_grid(self):
        """Sum the copies of every node and turn momentum into velocity."""
        for n in range(self.stencil.tile_count[None] * TILE * self.clock.running[None]):
            tile, inner = n // TILE, in_copy(node_in_tile(n))
            total = vec4(0.0)
            for corner in range(8):
                b = self.stencil.source[tile, corner]
                if b >= 0:
                    total += self.stencil.nodes[b * COPY + corner_offset(corner) + inner]
            if total[3] > 0.0:
                velocity = vec3(total[0] / total[3], total[1] / total[3], total[2] / total[3])
                velocity = self.walls.apply(self.stencil.node_position(tile, n), velocity)
                result = vec4(velocity, total[3])
                for corner in range(8):
                    b = self.stencil.source[tile, corner]
                    if b >= 0:
                        self.stencil.nodes[b * COPY + corner_offset(corner) + inner] = result

    @ti.kernel
    def grid_to_particles(self):
        """Move and deform every particle with the velocity of its nodes (g2p)."""
        if ti.static(not self.stencil.atomic):
            for t in range(self.stencil.block_count[None] * self.clock.running[None] * TASK):
                if t & (TASK - 1) == 0:
                    self.report(self.gather_block(t // TASK))
        else:
            for p in range(self.stencil.shared_count[None] * self.clock.running[None]):
                self.report(self.gather(p, self.stencil.owner[p]))
        for k in range(self.stencil.ballistic_count[None] * self.clock.running[None]):
            p = self.stencil.shared_count[None] + k
            self.report(self.scheme.advance_ballistic(p, self.dx()))
            self.check_margin(p)

    @ti.func
    def scatter_block(self, b):
        """Clear the copy of block b and scatter its particles."""
        for n in range(b * COPY, (b + 1) * COPY):
            self.stencil.nodes[n] = vec4(0.0)
        for p in range(self.stencil.first[b], self.stencil.first[b + 1]):
            self.scatter(p, b)

    @ti.func
    def gather_block(self, b):
        """Advance the particles of block b; returns the tightest limits of their next time step."""
        limits = Limits(0.0, 0.0, 0.0, 0.0)
        for p in range(self.stencil.first[b], self.stencil.first[b + 1]):
            limits = tightest(limits, self.gather(p, b))
        return limits

    @ti.func
    def scatter(self, p, b):
        """Add particle p to the nodes of block b."""
        n, f = self.stencil.locate(p, b)
        mass, momentum, affine = self.scheme.momentum(p, self.dx())
        self.stencil.scatter(n, f, mass, momentum, affine)

    @ti.func
    def gather(self, p, b):
        """Advance particle p with the velocity of its nodes in block b; returns its limits of the next time step."""
        n, f = self.stencil.locate(p, b)
        w = spline_weights(f)
        v, mass, L = self.stencil.gather(n, f, w)
        limits = Limits(0.0, 0.0, 0.0, 0.0)
        if self.stencil.is_ballistic(p, n, w, mass):
            limits = self.scheme.advance_ballistic(p, self.dx())
        else:
            limits = self.scheme.advance(p, v, L, self.dx())
        self.check_margin(p)
        return limits

    @ti.func
    def report(self, limits):
        """Tell the clock how long the next step may be."""
        self.clock.report_rate(rate_of(limits, self.cfl[None], self.dx()))

    @ti.func
    def check_margin(self, p):
        """Ask for new blocks once particle p has moved out of its block by a cell."""
        if not self.stencil.within_margin(p):
            self.clock.report_moved_out()

    @ti.func
    def dx(self):
        """Return the grid spacing [m] in the precision of the fields."""
        return ti.cast(self.stencil.dx[None], Real)


@ti.func
def corner_offset(corner):
    """Return the index of the first node of a tile in the copy of the block at one of its corners."""
    return in_copy(BLOCK_EDGE * corner_coordinates(corner))
