"""Outcomes as Datasets with units and origin, and their files."""
