"""Loads on a rod, one kind per file; `rods.problem.LOADS` lists them."""
