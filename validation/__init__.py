"""Independent references, virtual machines, trials and measurements: what shows that the project is right.

Each folder says in its first sentence what it proves.
"""
