"""Scatter: the numbers of a scene whose parameters scatter within their tolerances."""
