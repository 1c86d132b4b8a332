"""Proves how fast the project is, each measurement beside what one would use instead."""
