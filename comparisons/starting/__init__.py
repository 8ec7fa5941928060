"""A first scene to start from, and what an editor needs to help with it."""
