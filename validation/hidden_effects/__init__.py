"""Virtual measurements with one hidden effect, made without the core (see README.md)."""
