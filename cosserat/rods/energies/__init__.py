"""Strain energies of the discrete rod."""

import cosserat.solvers  # noqa: F401 - chooses where compiled kernels are kept, before any energy imports Numba
