"""What ties the records together: everything that is wrong with a scene, at once."""

from __future__ import annotations

from dataclasses import replace

from cprbm_scene.check_assembly import wrong_assembly
from cprbm_scene.check_beam_loads import wrong_beam_loads
from cprbm_scene.check_beside_itself import beside_themselves
from cprbm_scene.check_circles import circle_overlaps, wrong_circles
from cprbm_scene.check_closing import open_linkages
from cprbm_scene.check_drives import wrong_drives, wrong_guides
from cprbm_scene.check_edges import edge_overlaps, wrong_edges
from cprbm_scene.check_motion import wrong_loads, wrong_stages, wrong_supports
from cprbm_scene.check_names import repeated_names, unknown_names
from cprbm_scene.check_overlaps import overlaps, wrong_contacts
from cprbm_scene.check_paper import wrong_hints, wrong_spacings
from cprbm_scene.check_pins import loose_bodies, wrong_pins
from cprbm_scene.check_profiles import wrong_profiles
from cprbm_scene.check_questions import wrong_claims, wrong_probes
from cprbm_scene.check_shapes import wrong_curves, wrong_ends, wrong_sections
from cprbm_scene.check_stops import wrong_stops
from cprbm_scene.mistakes import Mistake, first_of
from cprbm_scene.statement import Scene

_CHECKS = (
    repeated_names,
    unknown_names,
    wrong_curves,
    wrong_profiles,
    wrong_sections,
    beside_themselves,
    wrong_ends,
    wrong_assembly,
    wrong_stops,
    wrong_guides,
    wrong_pins,
    wrong_supports,
    loose_bodies,
    wrong_loads,
    wrong_beam_loads,
    wrong_drives,
    wrong_contacts,
    wrong_spacings,
    wrong_hints,
    overlaps,
    wrong_circles,
    circle_overlaps,
    wrong_edges,
    edge_overlaps,
    wrong_stages,
    wrong_probes,
    wrong_claims,
)

_LAST = (open_linkages,)
"""What is asked of a scene in which nothing else is wrong."""


def mistakes_in(scene: Scene) -> list[Mistake]:
    """What is wrong in what ties the records of ``scene`` together; empty where it is a good question.

    A check that needs what another one found wrong keeps silent, so that one slip is named once.
    """
    found = first_of(mistake for check in _CHECKS for mistake in check(scene))
    found = found or first_of(mistake for check in _LAST for mistake in check(scene))
    return [replace(mistake, file=scene.file) for mistake in found]
