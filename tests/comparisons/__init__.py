"""Tests of the harness, on made-up answers."""
