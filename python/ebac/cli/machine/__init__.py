"""Commands about this machine: `ebac doctor`, `ebac jitter`."""
