"""Edits of plain scene data for tests, and beams on given curves."""

import copy

import numpy as np

from comparisons import cases
from cprbm_scene import Beam, FreeEnd, SceneError, scene_from
from cprbm_scene.clearance import beam_gap
from cprbm_scene.curve_records import shape_of
from cprbm_scene.curves import least

HINGE = cases.data("hinge")
REMOVED = object()


def edited(*edits, base=HINGE):
    """``base`` with each (path, value) put in; REMOVED takes the key away."""
    data = copy.deepcopy(base)
    for path, value in edits:
        keys = [int(key) if key.isdigit() else key for key in path.split("/")]
        place = data
        for key in keys[:-1]:
            place = place[key]
        if value is REMOVED:
            del place[keys[-1]]
        elif isinstance(place, list) and keys[-1] == len(place):
            place.append(value)
        else:
            place[keys[-1]] = value
    return data


def mistakes(*edits, base=HINGE):
    """Key, and the two halves of the sentence, of each mistake that the edits make."""
    try:
        scene_from(edited(*edits, base=base), file="case.toml")
    except SceneError as error:
        return {mistake.key: f"{mistake.found}; {mistake.allowed}" for mistake in error.mistakes}
    return {}


def two_lines(gap, *, thick=True, second=None):
    """Two level cantilevers of 0.1 m, 2 mm thick, their neutral lines ``gap`` apart."""
    ends = second or ((0.0, gap), (0.1, gap))
    beam = {"thickness": 0.002, "width": 0.01, "material": "steel", "end": {"joint": "weld", "point": "Q"}}
    return {
        "name": "pair",
        "theory": "bending",
        "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"O": [0.0, 0.0], "P": list(ends[0])}},
            "block": {"motion": "free", "points": {"Q": [0.1, 0.0]}},
        },
        "beams": {
            "lower": {
                **beam,
                "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.1, 0.0]},
                "start": {"joint": "weld", "point": "O"},
            },
            "upper": {
                **beam,
                "curve": {"kind": "line", "start": list(ends[0]), "end": list(ends[1])},
                "start": {"joint": "weld", "point": "P"},
                "end": {"joint": "free"},
            },
        },
        "loads": {"F": {"kind": "force", "point": "Q", "direction": [0.0, 1.0]}},
        "contacts": {"touch": {"kind": "beam-beam", "between": ["lower", "upper"], "thick": thick}},
        "stages": [{"name": "load", "steps": "F", "stations": [1.0]}],
        "probes": [{"of": "Q", "quantity": "displacement"}],
    }


def beam_on(curve, thickness):
    """A beam along a curve, without joints."""
    free = FreeEnd(joint="free")
    thickness = thickness or 1e-4 * shape_of(curve).length
    return Beam(curve=curve, thickness=thickness, width=0.01, material="m", start=free, end=free)


def line_distance(first, second, near=0.0):
    """Least distance of two neutral lines, m, that is ``near`` a value; a distance far above is not refined."""
    return near + beam_gap(beam_on(first, near), beam_on(second, near), thick=near > 0.0)[0]


def distance_to(curve, point):
    """Least distance of a neutral line from a point, m."""
    return least(lambda u: np.hypot(*(shape_of(curve).point(u) - point).T), np.linspace(0.0, 1.0, 2001))[0]
