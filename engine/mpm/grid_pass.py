"""One pass over the grid: particles give to their nodes, nodes sum, particles take (engine/physics.md, section 1).

One loop over the tiles sums the copies of every node in a fixed order and writes the mean back into each. On the CPU
one thread works on one block at a time, on a GPU on one node or one particle: no number is added to by two threads, so
the same run has the same bits.
"""

import taichi as ti

from engine.device.backend import TASK, Real, vec3, vec4
from engine.device.fields import allocate
from engine.device.launches import Kernel
from engine.mpm.interfaces import ContactLaw, Exchange
from engine.mpm.spline import WIDTH, spline_weights, weight_of
from engine.mpm.stencil import COPY, TILE, Stencil, node_in_tile
from engine.mpm.time_step import no_limits, rate_of, tightest
from engine.state.clock import Clock


@ti.data_oriented
class GridPass:
    """An exchange of all particles with the grid.

    Args:
        stencil: nodes of the particles.
        exchange: what a particle gives and takes.
        contact: where bodies touch.
        clock: whether the step runs, and how long the next one may be.
        cfl: Courant number: time step in units of the time a signal needs for one cell [-].
    """

    def __init__(self, stencil: Stencil, exchange: Exchange, contact: ContactLaw, clock: Clock, cfl: float) -> None:
        self.stencil, self.exchange, self.contact, self.clock = stencil, exchange, contact, clock
        self.cfl = allocate(Real)
        self.cfl[None] = cfl

    @property
    def name(self) -> str:
        """Name of the exchange."""
        return self.exchange.name

    @property
    def kernels(self) -> tuple[Kernel, ...]:
        """Loops over blocks, nodes, and blocks."""
        return self.particles_to_grid, self.update_grid, self.grid_to_particles

    @ti.kernel
    def particles_to_grid(self):
        """Add to the nodes what every particle gives (p2g)."""
        blocks = self.stencil.block_count[None] * self.clock.running[None]
        if ti.static(self.stencil.by_node):
            for n in range(blocks * COPY):
                self.stencil.nodes[n] = self.given_to(n)
        else:
            for t in range(blocks * TASK):
                if t & (TASK - 1) == 0:
                    self.scatter_block(t // TASK)

    @ti.kernel
    def update_grid(self):
        """Sum the copies of every node, of all bodies where they touch, and divide by the mass."""
        for n in range(self.stencil.site_count[None] * TILE * self.clock.running[None]):
            node = node_in_tile(n)
            first, last = self.stencil.site[n // TILE], self.stencil.site[n // TILE + 1]
            if ti.static(self.contact.separates):
                self.join_bodies(first, last, node)
            else:
                self.set_velocity(first, node, self.stencil.sum_of_copies(first, node))

    @ti.func
    def join_bodies(self, first, last, node):
        """Give those bodies of tiles `first` to `last`, without it, one velocity that touch the others at a node."""
        filled, joint, joined = ti.cast(0.0, Real), vec4(0.0), 0
        if last - first > 1:
            for tile in range(first, last):
                filled += self.filled(tile, self.stencil.sum_of_copies(tile, node))
            for tile in range(first, last):
                own = self.stencil.sum_of_copies(tile, node)
                if self.contact.touches(self.filled(tile, own), filled):
                    joint += own
                    joined += 1
        if joined > 1:
            self.clock.report_contact()
        for tile in range(first, last):
            value = joint
            if joined < last - first:
                own = self.stencil.sum_of_copies(tile, node)
                if not self.contact.touches(self.filled(tile, own), filled):
                    value = own
            self.set_velocity(tile, node, value)

    @ti.func
    def filled(self, tile, own):
        """Return what the body of a tile fills of a node to which it gives momentum and mass `own` [-]."""
        return self.contact.filled(own[3], self.stencil.body[tile])

    @ti.func
    def set_velocity(self, tile, node, total):
        """Write the mean of what a node of a tile was given, and its mass, into all its copies."""
        if total[3] > 0.0:
            mean = vec3(total[0] / total[3], total[1] / total[3], total[2] / total[3])
            mean = self.exchange.nodes.apply(self.stencil.node_position(tile, node), mean)
            self.stencil.set_copies(tile, node, vec4(mean, total[3]))

    @ti.kernel
    def grid_to_particles(self):
        """Let every particle take from its nodes (g2p)."""
        if ti.static(self.stencil.by_node):
            for p in range(self.stencil.shared_count[None] * self.clock.running[None]):
                self.report(self.gather(p, self.stencil.owner[p]))
        else:
            for t in range(self.stencil.block_count[None] * self.clock.running[None] * TASK):
                if t & (TASK - 1) == 0:
                    self.report(self.gather_block(t // TASK))
        for k in range(self.stencil.ballistic_count[None] * self.clock.running[None]):
            self.report(self.exchange.take_alone(self.stencil.shared_count[None] + k, self.dx()))

    @ti.func
    def scatter_block(self, b):
        """Clear the copy of block b and scatter its particles."""
        for n in range(b * COPY, (b + 1) * COPY):
            self.stencil.nodes[n] = vec4(0.0)
        for p in range(self.stencil.first[b], self.stencil.first[b + 1]):
            self.scatter(p, b)

    @ti.func
    def gather_block(self, b):
        """Let the particles of block b take; returns the tightest limits of their next time step."""
        limits = no_limits()
        for p in range(self.stencil.first[b], self.stencil.first[b + 1]):
            limits = tightest(limits, self.gather(p, b))
        return limits

    @ti.func
    def given_to(self, n):
        """Return the sum of what the particles of its block give to node n: momentum [kg m/s] and mass [kg]."""
        total = vec4(0.0)
        for p in range(self.stencil.first[n // COPY], self.stencil.first[n // COPY + 1]):
            above, f = self.stencil.seen_from(p, n)
            if above.min() >= 0 and above.max() < WIDTH:
                mass, momentum, affine = self.exchange.give(p, self.dx())
                total += weight_of(spline_weights(f), above) * vec4(momentum + affine @ (above - f), mass)
        return total

    @ti.func
    def scatter(self, p, b):
        """Add what particle p gives to the nodes of block b."""
        n, f = self.stencil.locate(p, b)
        mass, momentum, affine = self.exchange.give(p, self.dx())
        self.stencil.scatter(n, f, mass, momentum, affine)

    @ti.func
    def gather(self, p, b):
        """Let particle p take from its nodes in block b; returns its limits of the next time step."""
        n, f = self.stencil.locate(p, b)
        w = spline_weights(f)
        v, mass, L = self.stencil.gather(n, f, w)
        limits = no_limits()
        if self.stencil.is_ballistic(p, n, w, mass):
            limits = self.exchange.take_alone(p, self.dx())
        else:
            limits = self.exchange.take(p, v, L, self.dx())
        return limits

    @ti.func
    def report(self, limits):
        """Tell the clock how long the next step may be."""
        self.clock.report_rate(rate_of(limits, self.cfl[None], self.dx()))

    @ti.func
    def dx(self):
        """Return the grid spacing [m] in the precision of the fields."""
        return ti.cast(self.stencil.dx[None], Real)
