"""Proves that the core's equations are right: each written a second time, by other authors or another code."""
