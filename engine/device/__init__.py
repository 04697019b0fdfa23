"""device: Taichi, and arithmetic on it."""

import os

os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")  # read when Taichi is imported
