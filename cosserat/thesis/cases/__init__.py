"""The published cases."""
