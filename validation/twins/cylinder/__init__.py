"""A pneumatic cylinder pushed in and out against regulated pressure, with one hidden effect; it needs no numba."""
