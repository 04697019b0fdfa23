"""Gravity: of all particles on each other, or uniform."""
