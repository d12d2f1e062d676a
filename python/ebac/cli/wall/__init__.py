"""`ebac wall`."""
