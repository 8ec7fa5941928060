"""Sweeps: a scene at many values of its parameters."""
