"""`ebac log`."""
