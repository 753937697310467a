"""Answers to problems of other people by codes that share nothing with the package: `python -m tests.outside`."""
