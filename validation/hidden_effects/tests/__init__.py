"""Tests of the virtual cylinder itself; they need neither the core nor its Python package."""
