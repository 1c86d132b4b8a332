"""What an experiment can show: detection limits, the next experiment, and what a cause means in closed loop."""
