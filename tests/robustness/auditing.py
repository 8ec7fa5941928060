"""A crew that solves nothing twice and audits no answer twice."""

from __future__ import annotations

from dataclasses import dataclass, field

from comparisons.audit import Audit, audit
from comparisons.store import AnswerMemory
from cprbm_scene import Answer, Scene


@dataclass(frozen=True, slots=True)
class Auditing(AnswerMemory):
    """A crew with a memory of answers and of audits.

    Attributes:
        audited: findings of audits by the identities of the scene's and the stations' records; the records are kept, so
            that no other record takes over an identity.
    """

    audited: dict[tuple[int, ...], tuple[Scene, Answer, Audit]] = field(default_factory=dict)

    def audit(self, scene: Scene, answer: Answer) -> Audit:
        """The findings of the answer's audit, which is made once."""
        key = id(scene), *map(id, answer.stations)
        if key not in self.audited:
            self.audited[key] = scene, answer, audit(scene, answer)
        return self.audited[key][2]
