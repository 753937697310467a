"""All faults, in the order of the table."""

from . import kills, signals, disks, writers, damage, parts, surroundings  # noqa: F401, I001
