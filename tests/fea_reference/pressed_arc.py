"""An arc from a clamp at the origin whose pinned end is driven along its chord, between planes of the wall."""

from typing import Any

from cprbm_scene import Scene, scene_from


def pressed_arc(
    material: tuple[float, float],
    center: tuple[float, float],
    tip: tuple[float, float],
    along: tuple[float, float],
    section: tuple[Any, float],
    planes: dict[str, tuple[tuple[float, float], tuple[float, float]]],
    stations: list[float],
    beyond: str | None = None,
) -> Scene:
    """The scene, by E and ν of the ``material``, thickness and width, and of each of the ``planes`` a point and normal.

    The tip slides ``along`` its chord, and is driven back to the clamp by the ``stations``.
    """
    return scene_from(
        {
            "name": "pressed-arc",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": material[0], "poisson_ratio": material[1]}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "slides", "along": along, "points": {"T": tip}},
            },
            "beams": {
                "beam": {
                    "curve": {
                        "kind": "arc",
                        "center": center,
                        "start": [0.0, 0.0],
                        "end": tip,
                        "direction": "clockwise",
                    },
                    "thickness": section[0],
                    "width": section[1],
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "pin", "point": "T"},
                }
            },
            "drives": {"press": {"kind": "displacement", "point": "T", "direction": [-along[0], -along[1]]}},
            "contacts": {
                name: {"kind": "beam-half-plane", "beam": "beam", "body": "wall", "point": point, "normal": normal}
                for name, (point, normal) in planes.items()
            },
            "stages": [
                {"name": "press", "steps": "press", "stations": stations} | ({"beyond": beyond} if beyond else {})
            ],
            "probes": [
                {"of": "scene", "quantity": "potential_energy"},
                *({"of": name, "quantity": "force"} for name in planes),
            ],
        }
    )
