"""Virtual machines with one thing wrong, which share no code with the core: what trials diagnose and identify."""
