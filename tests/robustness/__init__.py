"""Numerical stability on random scenes: drawn, solved by both, sorted by how they end."""
