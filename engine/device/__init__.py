"""Taichi: starting it, fields, and arithmetic on them."""

import os

os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")  # read when Taichi is imported
