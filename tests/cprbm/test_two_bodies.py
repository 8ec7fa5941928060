"""A frame of three beams and two free bodies, one beam drawn from body to body; which body is first is no matter."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import scene_from
from tests.cprbm.scenes import MODULUS, THICKNESS, WIDTH

LOADS = {"P": 0.31, "M": 0.0137}
REACTIONS = ("R.reaction", "S.reaction", "S.reaction_moment")
MOTIONS = ("B.displacement", "D.displacement", "left.rotation", "right.rotation")


def beam(start, first, end, last, bent=None):
    line = {"kind": "line", "start": start, "end": end}
    arc = {"kind": "arc", "start": start, "end": end, "center": bent, "direction": "clockwise"}
    return {
        "curve": line if bent is None else arc,
        "thickness": THICKNESS,
        "width": WIDTH,
        "material": "m",
        "start": {"joint": first[0], "point": first[1]},
        "end": {"joint": last[0], "point": last[1]},
    }


def frame(order):
    """Columns R-A and S-D on the ground, and an arc drawn from C on the right body to B on the left one."""
    R, A, B = [0.0, 0.0], [0.011, 0.067], [0.0172, 0.071]
    S, D, C = [0.0913, -0.004], [0.083, 0.0591], [0.0772, 0.071]
    bodies = {
        "left": {"motion": "free", "points": {"A": A, "B": B}},
        "right": {"motion": "free", "points": {"D": D, "C": C}},
    }
    return scene_from(
        {
            "name": "frame",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.31}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"R": R, "S": S}},
                **{name: bodies[name] for name in order},
            },
            "beams": {
                "one": beam(R, ("pin", "R"), A, ("weld", "A")),
                "two": beam(C, ("weld", "C"), B, ("pin", "B"), bent=[0.0472, 0.101]),
                "three": beam(S, ("weld", "S"), D, ("weld", "D")),
            },
            "loads": {
                "P": {"kind": "force", "point": "B", "direction": [0.7, -0.4]},
                "M": {"kind": "moment", "body": "right"},
            },
            "stages": [{"name": name, "steps": name, "stations": [value]} for name, value in LOADS.items()],
            "probes": [
                *({"of": name.split(".")[0], "quantity": name.split(".")[1]} for name in (*MOTIONS, *REACTIONS)),
                {"of": "two", "quantity": "bending_stress", "points": 7},
                {"of": "scene", "quantity": "potential_energy"},
            ],
        }
    )


def test_the_order_of_the_bodies_does_not_matter():
    one, other = (cprbm.answer(frame(order)) for order in (("left", "right"), ("right", "left")))
    assert one.completed, one.sentence
    assert other.completed, other.sentence
    for first, second in zip(one.stations, other.stations, strict=True):
        assert first.certificate.iterations <= 12  # a wrong second derivative makes Newton's method slow
        for name, value in first.values.items():
            assert second.values[name] == pytest.approx(value, rel=1e-8, abs=1e-8 * np.max(np.abs(value))), name


def test_the_supports_balance_the_loads():
    # reference: statics of the whole frame about the origin, the force taken at B's moved place
    scene = frame(("left", "right"))
    values = cprbm.answer(scene).stations[-1].values
    force = LOADS["P"] * np.array([0.7, -0.4]) / np.hypot(0.7, 0.4)
    total = values["R.reaction"] + values["S.reaction"] + force
    assert np.hypot(*total) < 1e-9 * LOADS["P"]
    B = np.array(scene.bodies["left"].points["B"]) + values["B.displacement"]
    S = scene.bodies["ground"].points["S"]
    moments = (
        values["S.reaction_moment"][0],
        S[0] * values["S.reaction"][1] - S[1] * values["S.reaction"][0],
        B[0] * force[1] - B[1] * force[0],
        LOADS["M"],
    )
    assert abs(sum(moments)) < 1e-9 * max(map(abs, moments))
