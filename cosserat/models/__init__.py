"""The mechanics: rods, their energies, and the problems one can pose with them."""

import cosserat.solvers  # noqa: F401 - chooses where compiled kernels are kept, before any model imports Numba
