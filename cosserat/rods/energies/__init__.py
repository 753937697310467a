"""Strain energies of the discrete rod."""
