"""Run time against error: the project's own solvers beside the optimisers that a user would take instead."""
