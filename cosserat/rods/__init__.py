"""Rods: kinematics, reference configurations, energies, loads and constraints."""
