"""Solutions as Datasets with units and origin, and their files."""
