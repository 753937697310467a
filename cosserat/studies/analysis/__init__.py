"""What is done with the answer of a study: indices, bands, orders of convergence, estimated errors."""
