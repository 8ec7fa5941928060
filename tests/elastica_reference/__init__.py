"""The exact solution against references that share nothing with it, and against itself."""
