"""The largest remnant of one job: its particles, mass, shape, spin and what the run conserved."""
