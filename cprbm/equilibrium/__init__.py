"""Equilibria of a mechanism: Newton's method, exact elimination with inertia, certificate, stability."""
