"""Path following: load steps, stops, critical points, energy descent, assembly."""
