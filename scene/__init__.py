"""Neutral ground: the problem statement and the answer sheet.

This room states; it never computes mechanics.  Both solvers read the same
:class:`~scene.statement.Scene` and hand back the same
:class:`~scene.answer.Answer`, and share nothing else.
"""

from scene.answer import Answer, Certificate, Critical, Ending, Event, Loss, Shape, StationAnswer
from scene.mistakes import Mistake, SceneError
from scene.offset import OffsetClaim, OffsetQuestion, Spacing
from scene.reading import Question, read, read_question
from scene.statement import (
    Arc,
    Beam,
    BeamContact,
    BeamEnd,
    Body,
    CircleContact,
    Claim,
    Drive,
    FreeEnd,
    Line,
    Load,
    Material,
    PaperContact,
    PinnedEnd,
    Polynomial,
    Probe,
    Profile,
    Scene,
    Spline,
    Stage,
    Stop,
    WeldedEnd,
)

__all__ = [
    "Answer",
    "Arc",
    "Beam",
    "BeamContact",
    "BeamEnd",
    "Body",
    "Certificate",
    "CircleContact",
    "Claim",
    "Critical",
    "Drive",
    "Ending",
    "Event",
    "FreeEnd",
    "Line",
    "Load",
    "Loss",
    "Material",
    "Mistake",
    "OffsetClaim",
    "OffsetQuestion",
    "PaperContact",
    "PinnedEnd",
    "Polynomial",
    "Probe",
    "Profile",
    "Question",
    "Scene",
    "SceneError",
    "Shape",
    "Spacing",
    "Spline",
    "Stage",
    "StationAnswer",
    "Stop",
    "WeldedEnd",
    "read",
    "read_question",
]
