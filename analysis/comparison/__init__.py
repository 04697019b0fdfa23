"""A campaign beside what other methods find in the same collisions."""
