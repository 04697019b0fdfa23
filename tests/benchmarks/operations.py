"""Arithmetic of one step of one particle."""

PASSES = 3
"""Passes over the grid: kick, projection, correction."""
OPERATIONS = {
    # 9 rows: weight 1, momentum and mass 16, times weight 8; 27 nodes: momentum and mass 8, times weight 4, added 4
    "particles_to_grid": PASSES * (9 * 25 + 27 * 16 + 80),
    # three quotients and up to eight copies of four numbers on 0.75 nodes per particle
    "update_grid": PASSES * 20,
    # 9 rows: two sums over three nodes 40, added to three sums 24; 3 planes: added to four sums 32
    "grid_to_particles": PASSES * (9 * 64 + 3 * 32 + 80),
    # twice: (I + dt C)^-1, products and symmetric parts, det(I + dt C) - 1 and two norms; two norms more for the heat
    "drift": 2 * (215 + 45),
    # twelve numbers added in the kick; dt L (I - dt L/2)^-1 and the remainder; the filter with three products
    "motion": 12 + 130 + 120,
    # det(I + H) - 1 and two products of 3x3 matrices
    "deform": 150,
    # an inverse, two products, 8 terms of the series
    "half_log": 200,
    # a product and 8 terms, as if every particle yielded
    "exp_minus_identity": 140,
    "tillotson": 45,
    "strength, stress, energy": 150,
    # elastic energy before and after, and the work of shear and of viscous stress
    "dissipate": 70,
}
"""Additions, multiplications, divisions and roots of one particle and step in damaged rock, counted in the source."""


def operations_per_step() -> int:
    """Floating-point operations of one particle in one step."""
    return sum(OPERATIONS.values())
