"""Optimum: parameters for a goal within limits, and the check of the result."""
