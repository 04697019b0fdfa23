"""Constants that several rooms of the engine share."""

G_NEWTON = 6.6743e-11
"""Gravitational constant [m^3 kg^-1 s^-2] (CODATA 2018)."""

BLOCK_EDGE = 4
"""Number of cells along an edge of a block of the grid, and of nodes along an edge of a tile."""
