"""What a contact of the formulation ``auto`` can be asked, whatever touches."""

from __future__ import annotations

from typing import Protocol

from cprbm.first_contact import Group
from cprbm.kinematics import Positions, State
from cprbm.model import Chain
from cprbm_scene.answer import Array

THINNEST = 1e-3
"""Of the longest beam: of beams thinner than that an overlap with what is rigid is measured by it, as of lines by all
of the beam.  Between places a beam overlaps by what its elements leave of its shape, however thin it is.
"""

Pressed = tuple[float, Array, Array]
"""On one beam: the sign of the force, and places and tangent angles."""


class Touching(Protocol):
    """A beam and what it may touch; arc lengths are those of the first beam, all in units of length."""

    @property
    def name(self) -> str:
        """Of the contact."""

    @property
    def a(self) -> Chain:
        """The first beam."""

    @property
    def chains(self) -> tuple[Chain, ...]:
        """The beams: one where the other side is rigid."""

    @property
    def clamped(self) -> tuple[bool, bool]:
        """Whether the beam's start and end are clamped in touch with the other."""

    @property
    def thickness(self) -> float:
        """What an overlap is measured by."""

    @property
    def arching(self) -> float:
        """By how much a zone arches at most, of what the largest force can bend one element by."""

    def brought_to(self, state: State) -> Touching:
        """The same where drives have brought it in a state: what they hold in touch is clamped so."""

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""

    def least_gap(self, state: State, at: Positions) -> float:
        """Least gap anywhere along the beam, negative where it overlaps; infinite where nothing faces it."""

    def touching(self, state: State, at: Positions, s: Array) -> Array:
        """Where the edges touch that touch at arc lengths ``s``, (k, 2)."""

    def pressed(self, state: State, at: Positions, s: Array) -> tuple[Pressed, ...]:
        """On each of the beams what lies at ``s`` of the first."""

    def parting(self, state: State, at: Positions, s: Array) -> Array:
        """Curvature D″ with which the beam parts from what it touched, at arc lengths ``s``."""
