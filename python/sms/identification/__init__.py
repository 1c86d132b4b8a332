"""From test-bench records to parameters with standard errors that hold."""
