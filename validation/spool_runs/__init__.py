"""Records of a valve's spool by an independent simulator, and how well they are identified."""
