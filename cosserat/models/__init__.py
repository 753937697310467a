"""The mechanics: rods, their energies, and the problems one can pose with them."""
