"""Private helpers of the package; nothing here is public."""
