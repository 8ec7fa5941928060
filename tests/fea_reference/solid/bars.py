"""Scenes of one bar that is held at its start and carries a rigid body at its end."""

from cprbm_scene import scene_from

YOUNG, WIDTH = 1.3e9, 0.007


def bar(curve, thickness, *, poisson=0.0, load=None, stations=(1.0,), probes=(), contacts=None, end=None):
    """A bar from ``root`` to ``tip`` along ``curve``; ``load`` is P.  With an ``end`` of its own there is no body."""
    start, finish = list(curve["start"]), list(curve["end"])
    block = {} if end else {"block": {"motion": "free", "points": {"tip": finish}}}
    return scene_from(
        {
            "name": "bar",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": poisson}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"root": start}},
                **block,
            },
            "beams": {
                "beam": {
                    "curve": curve,
                    "thickness": thickness,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "root"},
                    "end": end or {"joint": "weld", "point": "tip"},
                }
            },
            "loads": {"P": load or {"kind": "force", "point": "tip", "direction": [0.0, 1.0]}},
            "contacts": contacts or {},
            "stages": [{"name": "load", "steps": "P", "stations": list(stations)}],
            "probes": [{"of": of, "quantity": quantity} for of, quantity in probes],
        }
    )


def straight(length):
    """A line from the origin along x."""
    return {"kind": "line", "start": [0.0, 0.0], "end": [length, 0.0]}


def quarter(radius):
    """A quarter of a circle about the origin, from the x-axis to the y-axis."""
    return {
        "kind": "arc",
        "center": [0.0, 0.0],
        "start": [radius, 0.0],
        "end": [0.0, radius],
        "direction": "counterclockwise",
    }
