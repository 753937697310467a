"""Studies: loops over problems."""
