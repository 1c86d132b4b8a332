"""What runs in the peers' own environment: it sees the exchanged numbers and nothing of the core."""
