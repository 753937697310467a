"""Crawlers of Chapter 2: bodies, muscle loads, one instant, and gaits."""

import cosserat.solvers  # noqa: F401 - chooses where compiled kernels are kept, before any crawler imports Numba
