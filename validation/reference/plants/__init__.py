"""Bench, platform and tank written a second time, for comparison (see README.md)."""
