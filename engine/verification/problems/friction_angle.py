"""Friction coefficients sqrt(J2)/P of a friction angle, by law and direction of shear (engine/physics.md, section 4).

Written apart from the engine: triaxial stresses follow from s1/s3 = (1 + sin phi)/(1 - sin phi), pure shear has s2 = P.
"""

from math import sin, sqrt, tan


def in_compression(phi: float) -> float:
    """Return the coefficient [-] in triaxial compression, s2 = s3, at a friction angle [rad]."""
    return 2.0 * sqrt(3.0) * sin(phi) / (3.0 - sin(phi))


def in_extension(phi: float) -> float:
    """Return the coefficient [-] in triaxial extension, s1 = s2, at a friction angle [rad]."""
    return 2.0 * sqrt(3.0) * sin(phi) / (3.0 + sin(phi))


def in_shear(law: str, phi: float) -> float:
    """Return the coefficient [-] in pure shear at a friction angle [rad].

    Principal stresses are P (1 + r), P and P (1 - r): (s1 - s3)/(s1 + s3) = r is sin phi by Mohr and Coulomb, and
    I1 I2/I3 = 3 (3 - r^2)/(1 - r^2) is 9 + 8 tan^2 phi by Matsuoka and Nakai.

    Args:
        law: `mohr-coulomb` or `matsuoka-nakai`.
        phi: friction angle [rad].
    """
    if law == "mohr-coulomb":
        return sin(phi)
    ratio = 9.0 + 8.0 * tan(phi) ** 2
    return sqrt((ratio - 9.0) / (ratio - 3.0))
