"""Sweeps: one scene at many values of its parameters."""
