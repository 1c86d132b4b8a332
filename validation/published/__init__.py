"""Proves which published figures the project reproduces, and what must be missing where it does not."""
