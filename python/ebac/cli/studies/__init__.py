"""Commands that run many simulations."""
