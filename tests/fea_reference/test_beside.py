"""Two contacts at one point of a mechanism: only the sum of their forces is determined."""

import numpy as np
import pytest

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer

RADIUS, THICKNESS = 0.05, 0.001


def ring(gap, *, contacts):
    """A ring of two semicircles, clamped below and pressed from above by a plate or, without contacts, at its top."""
    top, plate = [0.0, RADIUS], [0.0, RADIUS + 0.5 * THICKNESS + gap]
    halves = {"left": "clockwise", "right": "counterclockwise"}
    return scene_from(
        {
            "name": "ring",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": [0.0, -RADIUS]}},
                "plate": {"motion": "slides", "along": [0.0, 1.0], "points": {"P": plate}},
                "top": {"motion": "free", "points": {"T": top}},
            },
            "beams": {
                name: {
                    "curve": {"kind": "arc", "center": [0, 0], "start": [0, -RADIUS], "end": top, "direction": sense},
                    "thickness": THICKNESS,
                    "width": 0.01,
                    "material": "steel",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "weld", "point": "T"},
                }
                for name, sense in halves.items()
            },
            "drives": {
                "v": {"kind": "displacement", "point": "P" if contacts else "T", "direction": [0.0, -1.0]},
                **({} if contacts else {"held": {"kind": "displacement", "point": "P", "direction": [0.0, -1.0]}}),
            },
            "contacts": {
                f"at-{name}": {
                    "kind": "beam-half-plane",
                    "beam": name,
                    "body": "plate",
                    "point": plate,
                    "normal": [0.0, -1.0],
                }
                for name in halves
                if contacts
            },
            "stages": [{"name": "press", "steps": "v", "stations": [0.1 * RADIUS, 0.3 * RADIUS]}],
            "probes": [
                {"of": "P" if contacts else "T", "quantity": "reaction"},
                *({"of": f"at-{name}", "quantity": "force"} for name in halves if contacts),
            ],
        }
    )


@pytest.mark.parametrize(("gap", "elements"), [(0.0, 40), (0.02 * RADIUS, 20)])
def test_a_plate_presses_both_halves_of_a_ring_as_a_drive_presses_their_joint(gap, elements):
    settings = Settings(elements=elements, kinematics="bending")
    pressed = answer(ring(gap, contacts=True), settings)
    assert pressed.ending is Ending.COMPLETED, pressed.sentence
    for station in pressed.stations:
        values = station.values
        assert sum(values[f"at-{name}.force"][0] for name in ("left", "right")) == pytest.approx(
            np.hypot(*values["P.reaction"]), rel=1e-9
        )
    if gap == 0.0:
        driven = answer(ring(gap, contacts=False), settings)
        assert driven.ending is Ending.COMPLETED, driven.sentence
        for station, other in zip(pressed.stations, driven.stations, strict=True):
            assert station.values["P.reaction"] == pytest.approx(other.values["T.reaction"], rel=1e-6, abs=1e-6)
