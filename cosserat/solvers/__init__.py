"""Numerical methods that know nothing of rods."""
