"""Bench, platform and tank with one thing wrong, made without the core (see ../README.md)."""
