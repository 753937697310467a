"""Results for other programs: one tidy table, and the body as a mesh."""
