"""Formats of a figure's file, for those who do not draw."""

FORMATS = ("png", "pdf", "svg")
