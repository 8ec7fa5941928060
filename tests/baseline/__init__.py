"""The baseline: a record of both solvers and of the comparison, and the changes between two records.

``python -m tests.baseline record DIR`` writes a record, ``python -m tests.baseline compare OLD NEW`` compares two.
A record states the answers of a program. A record never shows that an answer is right.
"""
