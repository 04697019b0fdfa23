"""One time step of the Material Point Method: the passes of a scheme over the grid (engine/physics.md, section 1)."""

import taichi as ti

from engine.device.launches import Kernel, Launches
from engine.mpm.grid_pass import GridPass
from engine.mpm.interfaces import ContactLaw, Scheme, Stage
from engine.mpm.stencil import Stencil
from engine.state.clock import Clock


@ti.data_oriented
class Transfer:
    """Particles to grid and back.

    Args:
        stencil: nodes of the particles.
        scheme: what particles exchange with the grid.
        contact: where bodies touch.
        clock: time and time step.
        cfl: Courant number: time step in units of the time a signal needs for one cell [-].

    Attributes:
        stages: of a step, in order.
        step: advances all particles by one time step, unless the clock says to pause.
    """

    def __init__(self, stencil: Stencil, scheme: Scheme, contact: ContactLaw, clock: Clock, cfl: float) -> None:
        self.clock = clock
        self.stages = scheme.stages(lambda exchange: GridPass(stencil, exchange, contact, clock, cfl))
        parts: tuple[Stage, ...] = (self, *self.stages)
        self.step: Kernel = Launches(*(kernel for part in parts for kernel in part.kernels))

    @property
    def kernels(self) -> tuple[Kernel, ...]:
        """What comes before the stages."""
        return (self.begin,)

    @ti.kernel
    def begin(self):
        """Set the length of the step."""
        self.clock.begin_step()
