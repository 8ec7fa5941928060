"""The audit of answers by scene and answer alone: statics, section law, joints, contacts, energy path, probes.

A solver's certificate says that the solver's equations hold.  The audit says that the stated forces are in equilibrium
and belong to the stated shape, whatever the solver.
"""

from comparisons.audit.report import Audit, audit

__all__ = ["Audit", "audit"]
