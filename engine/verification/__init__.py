"""Scenes with known answers, run by `python -m engine verify`."""
