"""Materials of verification problems: simple limits of Tillotson's rock."""

from engine.scene.material import Material, TillotsonParameters

NEGLIGIBLE = 1e-12
"""Grueneisen constants so small that heat makes no pressure."""


def condensed_pressure(material: Material, mu: float, E: float) -> float:
    """Pressure [Pa] of compressed or cold matter, apart from the engine (engine/physics.md, section 2).

    Args:
        material: what it is of.
        mu: rho/rho0 - 1 [-].
        E: specific internal energy [J/kg].
    """
    t, eta = material.tillotson, 1.0 + mu
    gruneisen = t.a + t.b / (E / (t.E0 * eta**2) + 1.0)
    return gruneisen * (material.rho0 * eta) * E + t.A * mu + t.B * mu**2


def elastic(rho0: float, bulk: float, shear: float, friction: float = 0.0) -> Material:
    """Matter of constant moduli, P = K (rho/rho0 - 1), without cohesion.

    Args:
        rho0: density [kg/m^3].
        bulk, shear: moduli [Pa].
        friction: coefficient mu_d once damaged [-].
    """
    cold = TillotsonParameters(a=NEGLIGIBLE, b=NEGLIGIBLE, A=bulk, B=0.0)
    return Material(rho0=rho0, tillotson=cold, shear_modulus=shear, damaged_friction=friction)
