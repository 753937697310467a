"""What reproduces one publication: E. G. Hemingway's thesis (Berkeley, 2020)."""
