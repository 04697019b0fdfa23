"""A study in, a directory of finished jobs out: on one machine or many."""
