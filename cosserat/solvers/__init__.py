"""Numerical methods, independent of rods."""

from cosserat.solvers.kernels import choose_cache

choose_cache()  # before any module of this folder imports Numba
