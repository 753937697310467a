"""Loads on a rod, one kind a file; `LOADS` of `rods.problem` lists them."""
