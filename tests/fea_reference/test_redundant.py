"""Parallel guides of inextensible blades, whose constraints are redundant in the straight state.

Two blades hold the platform's height and rotation; every further blade repeats the constraints of these two, so that
the tangent of the undeformed mechanism is singular.
"""

import numpy as np
import pytest

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer

LENGTH, THICKNESS, WIDTH, YOUNG = 0.1, 0.0005, 0.01, 2e11
EI = YOUNG * WIDTH * THICKNESS**3 / 12.0
OFFSET = 1e-3  # lengths


def guide(blades, angle, tips=None):
    """A platform on equal blades along ``angle``, pushed across at half their height; ``tips`` are blades' lengths."""
    along, across = np.array([[np.cos(angle), np.sin(angle)], [np.sin(angle), -np.cos(angle)]])
    roots = [0.3 * LENGTH * i * across for i in range(blades)]
    ends = [root + length * along for root, length in zip(roots, tips or [LENGTH] * blades, strict=True)]
    middle = 0.5 * (roots[0] + roots[-1] + LENGTH * along)
    return scene_from(
        {
            "name": "guide",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {f"R{i}": list(root) for i, root in enumerate(roots)}},
                "platform": {
                    "motion": "free",
                    "points": {"P": list(middle), **{f"E{i}": list(end) for i, end in enumerate(ends)}},
                },
            },
            "beams": {
                f"blade{i}": {
                    "curve": {"kind": "line", "start": list(root), "end": list(end)},
                    "thickness": THICKNESS,
                    "width": WIDTH,
                    "material": "steel",
                    "start": {"joint": "weld", "point": f"R{i}"},
                    "end": {"joint": "weld", "point": f"E{i}"},
                }
                for i, (root, end) in enumerate(zip(roots, ends, strict=True))
            },
            "loads": {"F": {"kind": "force", "point": "P", "direction": list(across)}},
            "stages": [
                {
                    "name": "push",
                    "steps": "F",
                    "stations": [blades * 12.0 * EI / LENGTH**2 * OFFSET * k for k in (1, 50)],
                }
            ],
            "probes": [
                {"of": "P", "quantity": "displacement"},
                {"of": "platform", "quantity": "rotation"},
                *({"of": f"R{i}", "quantity": "reaction"} for i in range(blades)),
            ],
        }
    )


@pytest.mark.parametrize("elements", [20, 80])
@pytest.mark.parametrize("angle", [0.5 * np.pi, 0.93, 0.0])
@pytest.mark.parametrize("blades", [3, 4])
def test_every_blade_of_a_parallel_guide_bears_an_equal_share(blades, angle, elements):
    """A small offset is F L³/(12 n EI); the platform does not turn."""
    got = answer(guide(blades, angle), Settings(elements=elements, kinematics="bending"))
    assert got.ending is Ending.COMPLETED, got.sentence
    across = np.array([np.sin(angle), -np.cos(angle)])
    for station in got.stations:
        values = station.values
        pushes = [values[f"R{i}.reaction"] @ across for i in range(blades)]
        assert sum(pushes) == pytest.approx(-station.value, rel=1e-9)
        assert pushes == pytest.approx([-station.value / blades] * blades, rel=2e-3)
        assert values["platform.rotation"][0] == pytest.approx(0.0, abs=1e-5)
    small = got.stations[0].values
    assert small["P.displacement"] @ across == pytest.approx(OFFSET * LENGTH, rel=2e-6)
    shares = [small[f"R{i}.reaction"] @ across for i in range(blades)]
    assert shares == pytest.approx([-got.stations[0].value / blades] * blades, rel=5e-5)


def test_the_axial_forces_of_a_shorter_blade_are_determined():
    """Blades of unequal length shorten unequally, and the shape of the bent blades fixes their tension."""
    scene = guide(3, 0.5 * np.pi, [LENGTH, 0.8 * LENGTH, LENGTH])
    tensions = []
    for elements in (20, 40):
        got = answer(scene, Settings(elements=elements, kinematics="bending"))
        assert got.ending is Ending.COMPLETED, got.sentence
        tensions.append([got.stations[-1].values[f"R{i}.reaction"][1] for i in range(3)])
    assert tensions[1] == pytest.approx(tensions[0], rel=2e-4)
    assert sum(tensions[1]) == pytest.approx(0.0, abs=1e-9 * max(tensions[1]))
