"""Scaling of the largest remnant of a collision without friction by Leinhardt & Stewart 2012 (ApJ 745, 79)."""

import math

from engine.constants import G_NEWTON

Pair = tuple[float, float]
"""A value of target and projectile."""

COUPLING = 0.37
"""Their exponent mu-bar: between energy (2/3) and momentum (1/3) scaling."""

OFFSET = 5.0
"""Their c*, of small bodies: the energy that disperses half of the mass over the gravitational binding energy."""

REFERENCE_DENSITY = 1000.0
"""Density [kg/m^3] of the body of radius R_C1, which has all of the mass."""

SUPERCATASTROPHIC = 1.8
"""Energy over that of catastrophic disruption above which the largest remnant follows a power law."""


def largest_remnant(masses: Pair, radii: Pair, velocity: float, angle: float) -> float:
    """Return the mass of the largest remnant over that of the target; NaN where bodies hit and run.

    Args:
        masses: of target and projectile [kg].
        radii: of both [m].
        velocity: of impact [m/s].
        angle: of impact [deg], 0 is head-on.

    Source: Leinhardt & Stewart 2012, equations 5, 7, 11, 12, 15, 23, 28, 44; hit and run by Kokubo & Genda 2010.
    """
    (target, projectile), impact = masses, math.sin(math.radians(angle))
    total, ratio = target + projectile, projectile / target
    escape = math.sqrt(2.0 * G_NEWTON * total / sum(radii))
    if velocity <= escape:
        return total / target
    reduced, share = target * projectile / total, interacting_share(radii, impact)
    interacting = share * target * projectile / (share * projectile + target)
    critical = critical_energy(total, ratio) * math.pow(reduced / interacting, 2.0 - 1.5 * COUPLING)
    left = mass_left(0.5 * reduced * velocity**2 / total / critical) * total / target
    grazes = impact > radii[0] / sum(radii)
    passes = grazes and left >= 1.0 and velocity > escape * hit_and_run_ratio(ratio, impact)
    return math.nan if passes else left


def mass_left(energy: float) -> float:
    """Return the mass of the largest remnant over that of both bodies (equations 5 and 44).

    Args:
        energy: of the impact over that which disperses half of the mass [-].
    """
    if energy < SUPERCATASTROPHIC:
        return 1.0 - 0.5 * energy
    return 0.1 * math.pow(energy / SUPERCATASTROPHIC, -1.5)


def critical_energy(total: float, ratio: float) -> float:
    """Return the specific energy [J/kg] that disperses half of the mass in a head-on collision (equations 23 and 28).

    Args:
        total: mass of both bodies [kg].
        ratio: mass of the projectile over that of the target [-].
    """
    radius = math.cbrt(3.0 * total / (4.0 * math.pi * REFERENCE_DENSITY))
    equal = OFFSET * 0.8 * math.pi * REFERENCE_DENSITY * G_NEWTON * radius**2
    return equal * math.pow((ratio + 1.0) ** 2 / (4.0 * ratio), 2.0 / (3.0 * COUPLING) - 1.0)


def interacting_share(radii: Pair, impact: float) -> float:
    """Return the share of the projectile that meets the target (equations 7 and 11).

    Args:
        radii: of target and projectile [m].
        impact: sine of the impact angle [-].
    """
    overlap, r = sum(radii) * (1.0 - impact), radii[1]
    return 1.0 if overlap >= 2.0 * r else overlap**2 * (3.0 * r - overlap) / (4.0 * r**3)


def hit_and_run_ratio(ratio: float, impact: float) -> float:
    """Return the velocity over that of escape above which bodies that graze each other part (Kokubo & Genda 2010).

    Args:
        ratio: mass of the projectile over that of the target [-].
        impact: sine of the impact angle [-].
    """
    unlike, head_on = ((1.0 - ratio) / (1.0 + ratio)) ** 2, math.pow(1.0 - impact, 2.5)
    return 2.43 * unlike * head_on - 0.0408 * unlike + 1.86 * head_on + 1.08
