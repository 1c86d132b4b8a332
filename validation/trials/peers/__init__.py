"""What a user would do otherwise, on the same trials (see ../README.md)."""
