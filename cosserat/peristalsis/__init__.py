"""Crawlers of Chapter 2: bodies, muscle loads, one instant, and gaits."""
