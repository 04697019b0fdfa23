"""device: Taichi, and arithmetic on it."""
