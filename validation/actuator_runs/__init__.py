"""Runs of a healthy actuator on the bench by an independent simulator, and how well they are identified."""
