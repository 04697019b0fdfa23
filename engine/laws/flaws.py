"""Weibull flaws of a body and the strains that activate them (engine/physics.md, section 5; Benz & Asphaug 1994)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.scene.bodies import Body
from engine.scene.material import FractureRules


@dataclass(frozen=True)
class Flaws:
    """Activation strains of all flaws, sorted within each particle.

    Attributes:
        first: index of each particle's first flaw and, last, their number; shape [particle_count + 1].
        strain: activation strain [-], shape [flaw_count].
    """

    first: NDArray[np.int32]
    strain: NDArray[np.float64]


def draw_flaws(body: Body, fracture: FractureRules, generator: np.random.Generator) -> Flaws:
    """Draw the flaws of one body: flaw n = 1, 2, ... has strain (n / (k V))^(1/m) and falls on a random particle.

    Args:
        body: its volume V [m^3], and Weibull's k [m^-3] and m [-] of its material.
        fracture: says how many flaws are drawn.
        generator: of the random numbers.
    """
    owner = _owners(body.count, fracture, generator)
    number = np.arange(1, len(owner) + 1)
    k, m = body.material.known("weibull_k"), body.material.known("weibull_m")
    strain = (number / (k * body.volume)) ** (1.0 / m)
    order = np.argsort(owner, kind="stable")
    first = np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=body.count))])
    return Flaws(first.astype(np.int32), strain[order])


def _owners(particles: int, fracture: FractureRules, generator: np.random.Generator) -> NDArray[np.int64]:
    """Particle that each flaw falls on, shape [flaw_count]."""
    if fracture.flaws == "2NlnN":
        return np.asarray(generator.integers(particles, size=round(2.0 * particles * np.log(particles))))
    owners = generator.integers(particles, size=particles)
    while len(np.unique(owners)) < particles:
        owners = np.concatenate([owners, generator.integers(particles, size=particles)])
    _, first_use = np.unique(owners, return_index=True)
    return owners[: first_use.max() + 1]


def join(flaws: list[Flaws]) -> Flaws:
    """Return the flaws of several bodies as those of one, particles in the order of the bodies."""
    offsets = np.cumsum([0] + [len(part.strain) for part in flaws])
    first = [part.first[:-1] + offset for part, offset in zip(flaws, offsets, strict=False)]
    return Flaws(np.concatenate([*first, offsets[-1:]]).astype(np.int32), np.concatenate([p.strain for p in flaws]))
