"""Contact geometry of the second edition: curves, closest points, gaps, places."""
