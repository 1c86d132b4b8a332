"""One simulation step of the mechanism in general-purpose simulators, timed in their own environment."""
