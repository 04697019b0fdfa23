"""Scenes with known answers, one a file."""
