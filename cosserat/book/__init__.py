"""Chapters, executed and bound."""
