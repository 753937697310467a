"""Bad input of every kind, from the schema and by hand, and a judge of how each ends: `python -m tests.hostile`."""
