"""Proves that the methods work on measured data: a cylinder, vessels that fill and empty, a model in waves."""
