"""Exact answers of slender bodies: closed forms, and the elastica."""
