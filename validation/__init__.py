"""Independent references, published results side by side, hidden-effect trials."""
