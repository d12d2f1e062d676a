"""Commands that list what is known: laws, presets, specs."""
