"""Runs of an unloaded cylinder on the bench, made by an independent simulator."""
