"""What a long computation calls while it runs."""

from collections.abc import Callable

Progress = Callable[[str, float], None]
"""With what is being done and the share of the whole that is done, 0..1."""
