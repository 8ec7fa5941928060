"""N for a tolerance."""
