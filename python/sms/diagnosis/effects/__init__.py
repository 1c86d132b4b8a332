"""The effects that can be named: where each acts, what it needs to be seen, how large it can plausibly be."""
