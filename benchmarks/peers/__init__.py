"""Optimisers that a user would take instead, on the very problem that the formulation ``paper`` makes of a scene."""
