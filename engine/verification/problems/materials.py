"""Materials of verification problems: simple limits of Tillotson's rock."""

from engine.scene.material import Material, named

NEGLIGIBLE = 1e-12
"""Grueneisen constants so small that heat makes no pressure."""


def elastic(rho0: float, bulk: float, shear: float, friction: float = 0.0, law: str = "drucker-prager") -> Material:
    """Return a material of constant moduli, P = K (rho/rho0 - 1), without thermal pressure.

    Args:
        rho0: density [kg/m^3].
        bulk, shear: moduli [Pa].
        friction: coefficient mu_d once damaged [-].
        law: of friction.
    """
    cold = {"a": NEGLIGIBLE, "b": NEGLIGIBLE, "A": bulk, "B": 0.0}
    return named("basalt", rho0=rho0, eos=cold, shear_modulus=shear, friction=friction, friction_law=law)
