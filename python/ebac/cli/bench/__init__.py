"""`ebac bench`."""
