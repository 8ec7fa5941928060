"""A straight strip that is rolled by its end."""

from __future__ import annotations

from cprbm_scene import scene_from

MODULUS, WIDTH, THICKNESS = 3.0e9, 0.02, 0.005  # the latter two over the length
NARROWS = (0.0, 0.3, 0.9, 1.0), (1.0, 0.75, 0.75, 0.4)  # of a strip's width, which make a roll a spiral


def roll(stations, narrows=NARROWS, *, thick=True, backwards=False):
    """A scene of a strip of length one, its end turned to ``stations``, rad; ``backwards`` drawn from that end."""
    at, shares = narrows
    profile = (
        {"at": [1.0 - one for one in at[::-1]], "values": [WIDTH * one for one in shares[::-1]]}
        if backwards
        else {"at": list(at), "values": [WIDTH * one for one in shares]}
    )
    clamp, tip = ({"joint": "weld", "point": name} for name in ("C", "T"))
    places = {"C": [0.0, 0.0], "T": [1.0, 0.0]}
    ends = ("T", "C") if backwards else ("C", "T")
    return scene_from(
        {
            "name": "rolled",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"C": places["C"]}},
                "tip": {"motion": "free", "points": {"T": places["T"]}},
            },
            "beams": {
                "strip": {
                    "curve": {"kind": "line", "start": places[ends[0]], "end": places[ends[1]]},
                    "thickness": THICKNESS,
                    "width": profile,
                    "material": "m",
                    "start": tip if backwards else clamp,
                    "end": clamp if backwards else tip,
                }
            },
            "drives": {"turn": {"kind": "rotation", "body": "tip"}},
            "contacts": {"lap": {"kind": "beam-self", "beam": "strip", "thick": thick}},
            "stages": [{"name": "roll", "steps": "turn", "stations": list(stations)}],
            "probes": [
                {"of": "T", "quantity": "displacement"},
                {"of": "tip", "quantity": "reaction_moment"},
                {"of": "lap", "quantity": "force"},
                {"of": "lap", "quantity": "centre"},
                {"of": "lap", "quantity": "closing_load"},
                {"of": "scene", "quantity": "potential_energy"},
            ],
        }
    )
