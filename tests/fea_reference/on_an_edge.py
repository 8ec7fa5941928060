"""Beams of unit length and EI with edges that they may touch."""

from cprbm_scene import Scene

T, WIDTH = 0.01, 0.05


def scene_of(
    curve, start, end, contact, *, bodies=None, loads=None, drives=None, stages, pins=None, probes=(), thickness=T
):
    """One beam ``beam``, with a modulus that makes EI one, and the contact ``edge``."""
    return Scene.model_validate(
        {
            "name": "edge",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": 12.0 / (WIDTH * thickness**3), "poisson_ratio": 0.3}},
            "bodies": bodies,
            "beams": {
                "beam": {
                    "curve": curve,
                    "thickness": thickness,
                    "width": WIDTH,
                    "material": "m",
                    "start": start,
                    "end": end,
                }
            },
            "loads": loads or {},
            "drives": drives or {},
            "pins": pins or {},
            "contacts": {"edge": {"beam": "beam", **contact}},
            "stages": tuple({"name": f"s{i}", "steps": of, "stations": at} for i, (of, at) in enumerate(stages)),
            "probes": tuple({"of": of, "quantity": quantity} for of, quantity in probes),
        }
    )


def cantilever_over(contact, *, force=None, probes=(), body="ground"):
    """A cantilever from the origin along x with a block at its tip, which a force pulls down."""
    return scene_of(
        {"kind": "line", "start": (0.0, 0.0), "end": (1.0, 0.0)},
        {"joint": "weld", "point": "root"},
        {"joint": "weld", "point": "tip"},
        {"body": body, **contact},
        bodies={
            "ground": {"motion": "fixed", "points": {"root": (0.0, 0.0)}},
            "block": {"motion": "free", "points": {"tip": (1.0, 0.0), "corner": (1.1, 0.2)}},
        },
        loads={"P": {"kind": "force", "point": "tip", "direction": (0.0, -1.0)}},
        stages=(("P", (force or 1.0,)),),
        probes=(("tip", "displacement"), ("edge", "force"), ("edge", "ends"), ("scene", "potential_energy"), *probes),
    )
