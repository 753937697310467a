"""Cases: computations as data."""
