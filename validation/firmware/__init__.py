"""Proves that the application on the target has the desk's bits, keeps its time, and reacts to faults as stated."""
