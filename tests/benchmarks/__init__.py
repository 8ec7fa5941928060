"""Tests of the programs that the solvers are measured against."""
