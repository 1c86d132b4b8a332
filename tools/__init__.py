"""What makes the files of the repository that nobody writes by hand, and holds one build against another."""
