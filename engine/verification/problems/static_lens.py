"""Lenses of rubble above and below the thinnest that friction can hold (engine/physics.md, section 4)."""

from dataclasses import dataclass
from math import radians

from engine.verification.check import Check
from engine.verification.harness import Harness
from engine.verification.problems.ellipsoid import Lens, flat
from engine.verification.problems.friction_angle import in_compression, in_extension
from engine.verification.rubble_ellipsoid import thinnest_lens


@dataclass(frozen=True)
class Rubble:
    """Friction of a lens.

    Attributes:
        name: what checks call it.
        friction: coefficient in triaxial extension, the state of a flat lens [-].
        law: of friction.
        compression: coefficient in triaxial compression [-].
    """

    name: str
    friction: float
    law: str = "drucker-prager"
    compression: float | None = None

    def lens(self, ratio: float, particles: int) -> Lens:
        """Return an oblate lens at rest of a ratio c/a."""
        return flat(ratio, particles, self.friction, self.law, self.compression)


def with_angle(law: str, degrees: float) -> Rubble:
    """Return rubble of a friction angle."""
    phi = radians(degrees)
    return Rubble(f"{law} {degrees:g} deg", in_extension(phi), law, in_compression(phi))


RUBBLE = (
    Rubble("drucker-prager 0.5", 0.5),
    Rubble("drucker-prager 0.6", 0.6),
    with_angle("mohr-coulomb", 35.8),
    with_angle("mohr-coulomb", 40.0),
    with_angle("matsuoka-nakai", 40.0),
)
"""Friction whose thinnest lens is thick enough to be resolved: c/a of 0.278, 0.189, 0.219, 0.180 and 0.180."""


@dataclass(frozen=True)
class StaticLens:
    """A lens that is a little thicker than the thinnest at rest stays; one a little thinner contracts.

    Attributes:
        particles: of a lens.
        margin: from the thinnest c/a on either side [-].
    """

    name = "static_lens"
    particles: int = 2000
    margin: float = 0.03

    def checks(self, harness: Harness) -> list[Check]:
        """Compare c/a after 3,000 s with the exact one, for every kind of rubble."""
        return [check for rubble in RUBBLE for check in self._compare(rubble, harness)]

    def _compare(self, rubble: Rubble, harness: Harness) -> list[Check]:
        limit = thinnest_lens(rubble.friction)
        thick, thin = (rubble.lens(limit + side * self.margin, self.particles).measure(harness) for side in (1.0, -1.0))
        return [
            Check.absolute(f"{rubble.name}: c/a above the limit", "-", thick.ratio, thick.exact_ratio, 0.003),
            Check.absolute(f"{rubble.name}: c/a below the limit", "-", thin.ratio, thin.exact_ratio, 0.03),
        ]
