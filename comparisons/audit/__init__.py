"""The audit of answers: recomputed from scene and answer alone, by statics, with nothing of any solver.

A solver's own certificate says that its equations are solved; this says that what it hands out is in equilibrium, that
nothing passes through anything, that contacts push where beams touch, that the numbers asked are those of the state,
that the energy along the path is the work, and that the state is a minimum.
"""

from comparisons.audit.report import Audit, audit, audited

__all__ = ["Audit", "audit", "audited"]
