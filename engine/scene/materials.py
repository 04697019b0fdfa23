"""Constants of materials that a scene or study chooses by name; SI units as in engine.scene.material.Material.

A constant without a published value is left out: a scene whose physics needs it then asks for it.
"""

from typing import Any

BASALT: dict[str, Any] = {
    # Benz & Asphaug 1999 (Icarus 142, 5)
    "rho0": 2700.0,
    "eos": {
        "form": "tillotson",
        "a": 0.5,
        "b": 1.5,
        "A": 2.67e10,
        "B": 2.67e10,
        "E0": 4.87e8,
        "E_iv": 4.72e6,
        "E_cv": 1.82e7,
        "alpha": 5.0,
        "beta": 5.0,
    },
    "shear_modulus": 2.27e10,
    "weibull_k": 4.0e35,
    "weibull_m": 9.0,
    # Sugiura, Kobayashi & Inutsuka 2018 (A&A 620, A167), after Jutzi 2015
    "cohesion": 1.0e7,
    "intact_friction": 1.0,
    "strength_limit": 3.5e9,
    "melt_energy": 3.4e6,
    "friction": 0.839,  # tan 40 deg
}

ICE: dict[str, Any] = {
    # Benz & Asphaug 1999 (Icarus 142, 5): water ice at 255 K
    "rho0": 917.0,
    "eos": {
        "form": "tillotson",
        "a": 0.3,
        "b": 0.1,
        "A": 9.47e9,
        "B": 9.47e9,
        "E0": 1.0e7,
        "E_iv": 7.73e5,
        "E_cv": 3.04e6,
        "alpha": 10.0,
        "beta": 5.0,
    },
    "shear_modulus": 2.80e9,
    "strength_limit": 1.0e9,  # the yield stress there
    # read second-hand; codes that cite the paper also have k = 1e38 m^-3 and m = 9.1
    "weibull_k": 1.4e38,
    "weibull_m": 9.6,
    # no published cohesion, friction of intact or broken ice, and energy of melting for this law of strength
}

CONSTANTS = {"basalt": BASALT, "ice": ICE}
"""Constants by the name of the material."""
