"""From test-bench records to parameters with honest errors."""
