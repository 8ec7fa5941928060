"""A lever with a sharp wedge at its tip is pressed into a bow, and along it until the wedge's short face lies on it.

Beyond the end of that face the bow goes on far below what is rigid: the side that goes back from there meets the other
face behind it, and the side that goes back from the lever's other end passes over the bow's root.
"""

from cprbm_scene import scene_from
from tests.together import limits


def pressed_into_a_bow(*turns):
    tip = [-0.0453685, 0.0571218]
    return scene_from(
        {
            "name": "wedge-on-a-lever",
            "materials": {"m": {"youngs_modulus": 2.03e11, "poisson_ratio": 0.29}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "shoe": {"motion": "slides", "along": [-0.9945, -0.1049], "turns": True, "points": {"T": tip}},
                "lever": {"motion": "turns", "about": "D", "points": {"D": [-0.0777595, 0.0668802]}},
            },
            "beams": {
                "bow": {
                    "curve": {
                        "kind": "arc",
                        "center": [0.026343314845870196, 0.06750062311288968],
                        "start": [0.0, 0.0],
                        "end": tip,
                        "direction": "clockwise",
                    },
                    "thickness": 0.00123,
                    "width": 0.0213,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "drives": {"turn": {"kind": "rotation", "body": "lever"}},
            "contacts": {
                "wedge": {
                    "kind": "beam-line",
                    "beam": "bow",
                    "body": "lever",
                    "points": [[-0.0515696, 0.0090325], [-0.0269219, 0.0151522], [-0.0286319, 0.0079074]],
                    "side": "left",
                }
            },
            "stages": [{"name": "press", "steps": "turn", "stations": list(turns)}],
            "probes": [{"of": "T", "quantity": "displacement"}, {"of": "wedge", "quantity": "force"}],
        }
    )


def test_what_is_beyond_the_end_of_a_wedges_face_is_not_behind_its_other_side():
    """Reference: the finite elements; errors of the chain fall with the square of the link."""
    scene = pressed_into_a_bow(0.16, 0.31, 0.36, 0.413)
    limits.check(scene, 20, rel=2e-3)
