"""`ebac run`."""
