"""What happens to a run from outside, and what is promised then: `python -m tests.hostile.faults`."""
