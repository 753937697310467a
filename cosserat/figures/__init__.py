"""Figures of the thesis, drawn from stored Datasets."""
