"""Proves that the link holds: latency, a day of traffic, and every fault of rig, bus and desk."""
