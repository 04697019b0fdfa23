"""Limits of the time step: on the device for every step, on the host for the first (engine/physics.md, section 1)."""

import math

import numpy as np
import taichi as ti

from engine.arrays import Scalars
from engine.device.backend import Real
from engine.device.tensors import norm_squared, unpack
from engine.mpm.spline import SECOND_MOMENT
from engine.scene.bodies import Body
from engine.scene.material import Material
from engine.scene.scene import Scene
from engine.state.particles import Arrays

LARGEST_INCREMENT = 0.3
"""Largest deformation |dt L| of one step [-]."""

FIRST_INCREMENT = 0.003
"""Largest deformation [-] that stress alone makes in the first step: it acts at once on matter that was at rest."""


Limits = ti.types.struct(speed=Real, gradient2=Real, acceleration2=Real, diffusivity=Real)
"""What bounds the next time step: the speed of the fastest signal, the motion of matter included [m/s], the squares of
the velocity gradient [1/s^2] and of the acceleration [m^2/s^4], and the diffusivity of momentum [m^2/s].
"""


@ti.func
def no_limits():
    """Return limits that any time step satisfies."""
    return Limits(0.0, 0.0, 0.0, 0.0)


@ti.func
def tightest(a, b):
    """Return the limits that satisfy both."""
    return Limits(
        ti.max(a.speed, b.speed),
        ti.max(a.gradient2, b.gradient2),
        ti.max(a.acceleration2, b.acceleration2),
        ti.max(a.diffusivity, b.diffusivity),
    )


@ti.func
def rate_of(limits, cfl, dx):
    """Return the inverse time step [1/s] that limits demand.

    Args:
        limits: of one particle or of many.
        cfl: Courant number [-].
        dx: grid spacing [m].
    """
    wave, deformation = limits.speed / (cfl * dx), ti.sqrt(limits.gradient2) / LARGEST_INCREMENT
    fall, diffusion = ti.sqrt(ti.sqrt(limits.acceleration2) / dx), 6.0 * limits.diffusivity / (dx * dx)
    # waves and diffusion together: viscous stress is that of the step before
    return ti.max(wave + diffusion, deformation, fall)


@ti.func
def free_stress_gradient2(tau, rho0, dx):
    """Return the square [1/s^2] of the velocity gradient that limits dt as a stress that nothing balances does.

    It grows at |dL/dt| = |tau|/(rho0 m2 dx^2), with the second moment m2 of the spline, so |dL/dt| dt^2 < 0.3.

    Args:
        tau: Kirchhoff stress [Pa], six components.
        rho0: density of the reference state [kg/m^3].
        dx: grid spacing [m].
    """
    return LARGEST_INCREMENT * (ti.sqrt(norm_squared(unpack(tau))) / (SECOND_MOMENT * rho0 * dx * dx))


def first_rate(scene: Scene, state: Arrays, rho0: Scalars) -> float:
    """Return the inverse time step [1/s] that a scene begins with.

    Args:
        scene: whose bodies are at rest density and move at full speed.
        state: fields C and tau of every particle.
        rho0: reference density of every particle [kg/m^3], shape [particle_count].
    """
    speeds = [_fastest(body, material) for body, material in zip(scene.bodies, scene.materials, strict=True)]
    return max(max(speeds) / (scene.numerics.cfl * scene.dx), _rate_of_state(state, rho0, scene.dx))


def rate_of_motion(state: Arrays, dx: float) -> Scalars:
    """Return the inverse time step [1/s] that the motion of each particle demands, shape [particle_count].

    Args:
        state: fields v and C of every particle.
        dx: grid spacing [m].
    """
    return np.asarray(np.maximum(np.linalg.norm(state["v"], axis=1) / dx, _rate_of_deformation(state)))


def _rate_of_state(state: Arrays, rho0: Scalars, dx: float) -> float:
    """Inverse time step [1/s] that motion and stress inside particles demand."""
    stress = np.sqrt(np.sum(state["tau"] ** 2 * [1.0, 1.0, 1.0, 2.0, 2.0, 2.0], axis=1))
    growth = float((stress / rho0).max()) / (SECOND_MOMENT * dx**2)
    return max(float(_rate_of_deformation(state).max()), math.sqrt(growth / FIRST_INCREMENT))


def _rate_of_deformation(state: Arrays) -> Scalars:
    """Inverse time step [1/s] that the velocity gradient of each particle demands, shape [particle_count]."""
    return np.asarray(np.linalg.norm(state["C"], axis=(1, 2)) / LARGEST_INCREMENT)


def _fastest(body: Body, material: Material) -> float:
    """Highest signal speed [m/s] in an unstressed body."""
    rotation = float(np.linalg.norm(body.spin)) * body.reach
    return material.signal_speed + float(np.linalg.norm(body.velocity)) + rotation
