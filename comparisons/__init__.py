"""The harness: one scene to both solvers, their answers beside each other, and a verdict.

Only :mod:`comparisons.pairing` knows the solvers, and only :mod:`comparisons.figures` knows matplotlib.
"""
