"""Finished jobs in, their outcomes out: clumps, shapes, one data set, tables and figures."""
