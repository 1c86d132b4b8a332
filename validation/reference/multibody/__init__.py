"""The mechanism in two independent multibody codes, held against the core."""
