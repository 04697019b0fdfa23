"""Arithmetic of one step of one particle."""

OPERATIONS = {
    # 27 nodes: weight 2, offset 6, affine momentum 18, times weight 4, added to the node 4
    "particles_to_grid": 27 * 34 + 80,
    # three quotients and up to eight copies of four numbers on 0.75 nodes per particle
    "update_grid": 20,
    # 27 nodes: weight 2, weighted node 4, sum 4, outer product with the offset 21, mass shared with others 4
    "grid_to_particles": 27 * 35 + 60,
    # (I + dt L)^-1, products and symmetric parts, det(I + dt L) - 1 and two norms
    "affine_velocity": 215,
    # det(I + A) - 1 and four products of 3x3 matrices
    "deform": 220,
    # an inverse, two products, 14 terms of the series
    "half_log": 330,
    # a product and 12 terms, as if every particle yielded
    "exp_minus_identity": 200,
    "tillotson": 45,
    "strength, stress, energy": 150,
}
"""Additions, multiplications, divisions and roots of one particle and step in damaged rock, counted in the source."""


def operations_per_step() -> int:
    """Floating-point operations of one particle in one step."""
    return sum(OPERATIONS.values())
