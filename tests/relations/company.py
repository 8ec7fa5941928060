"""Something far away that nothing can touch."""

from __future__ import annotations

import numpy as np

from cprbm_scene import scene_from
from cprbm_scene.curve_records import shape_of
from tests.relations.image import Data, Image, copied

AWAY = 7.3
"""Distance of what is far, in extents of the scene."""


def far_circle(data: Data) -> Image:
    """A ground of its own with a rigid circle far away, which the first beam may touch.

    A scene without contacts is answered by another chain of the CPRBM than a scene with contacts, until its second
    edition answers both: the image of such a scene is another discretised problem.
    """
    scene = scene_from(data)
    u = np.linspace(0.0, 1.0, 9)
    points = np.concatenate(
        [
            *(np.array(list(body.points.values())) for body in scene.bodies.values()),
            *(shape_of(beam.curve).point(u) for beam in scene.beams.values()),
        ]
    )
    least, most = points.min(axis=0), points.max(axis=0)
    extent = float(np.linalg.norm(most - least))
    centre = [float(most[0] + AWAY * extent), float(least[1] - 0.61 * AWAY * extent)]
    new = copied(data)
    new["bodies"]["far_body"] = {"motion": "fixed", "points": {"far_point": centre}}
    new.setdefault("contacts", {})["far_contact"] = {
        "kind": "beam-circle",
        "beam": next(iter(data["beams"])),
        "body": "far_body",
        "center": centre,
        "radius": 0.37 * extent,
    }
    return Image("a circle far away", new, discretised_anew=not data.get("contacts"))
