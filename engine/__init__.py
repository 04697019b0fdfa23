"""One simulation: a scene in, a job directory out."""

PHYSICS_VERSION = 4
"""Raised by hand whenever the same scene gives other results."""
