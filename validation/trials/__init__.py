"""Proves what the diagnosis names and what the stated intervals hold: blind trials on virtual machines, counted."""
