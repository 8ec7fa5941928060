"""Public names of the product packages. Tests of all other names get the marker ``internals``.

A name becomes public together with an entry in ``__all__`` or on a page of ``docs/api``.
The tests in ``test_internals.py`` compare this list with both.
"""

from __future__ import annotations

EXPORTING = ("cprbm_scene", "cprbm", "fea_reference", "fea_reference.solid", "elastica_reference", "comparisons")
"""Packages with a public ``__all__``: users write ``from PACKAGE import NAME``.

The solid is a solver of its own inside ``fea_reference``, with the interface of the other solvers.
"""

DOCUMENTED = {
    # docs/api/cprbm_scene.md: the records of the answer sheet, filled by every solver
    "cprbm_scene.answer": (
        "Answer",
        "BeamState",
        "Certificate",
        "ContactState",
        "Critical",
        "Ending",
        "Event",
        "GoneOver",
        "Loss",
        "PointForce",
        "PointForces",
        "Shape",
        "StationAnswer",
        "frozen_array",
    ),
    # docs/api/cprbm_scene.md: the records of a scene
    "cprbm_scene.statement": (
        "Arc",
        "Assembly",
        "Beam",
        "BeamContact",
        "BeamForce",
        "BeamMoment",
        "CircleContact",
        "Claim",
        "BodyPin",
        "DisplacementDrive",
        "DistributedLoad",
        "EllipseContact",
        "FixedBody",
        "Force",
        "FreeBody",
        "FreeEnd",
        "FunctionContact",
        "HalfPlaneContact",
        "Line",
        "LineContact",
        "Material",
        "Moment",
        "PaperBeam",
        "PaperContact",
        "PaperRigid",
        "Parameter",
        "PinnedEnd",
        "Polynomial",
        "Probe",
        "Profile",
        "Related",
        "RigidContact",
        "RotationDrive",
        "Scene",
        "SelfContact",
        "SlidingBody",
        "Spline",
        "SplineContact",
        "Stage",
        "Stop",
        "Tolerance",
        "TurningBody",
        "Units",
        "WeldedEnd",
    ),
    # docs/api/cprbm_scene.md: the records of an offset question
    "cprbm_scene.offset": ("OffsetClaim", "OffsetQuestion", "Spacing"),
    # docs/api/comparisons.md: settings, built-in cases, the verdict and the rows, an answer as numbers, the audit
    "comparisons.choices": ("Choices",),
    "comparisons.answer_file": ("read_answers",),
    "comparisons.cases": ("asked", "names", "opened"),
    "comparisons.mechanism": ("Mechanism", "MechanismComparison"),
    "comparisons.case": ("Comparison", "Verdict"),
    "comparisons.verdict.runs": ("Bounds", "Runs"),
    "comparisons.verdict.rows": ("Row",),
    "comparisons.sweeps.running": ("Sweep",),
    "comparisons.reactions": ("Absence", "WorkEnergyReaction"),
    "comparisons.present.csv_table": ("Number",),
    "comparisons.audit": ("audit",),
}
"""Names on the pages of ``docs/api`` but not in ``__all__`` of a package, by module."""

ENTRIES = {
    # the program ``cprbm``: arguments in, exit code out, messages on the standard streams
    "comparisons.cli.main": ("run",),
    # the console script of pyproject.toml
    "comparisons.cli.program": ("main",),
}
"""Functions to start the program, by module."""
