"""The smallest curvature against dense eigenvalues on the null space of all rows, and its motions."""

from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigvalsh, null_space

from cprbm_scene import read, scene_from
from fea_reference import Settings
from fea_reference.contacts import contacts
from fea_reference.curvature import softest
from fea_reference.march import begin
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.system import assemble
from fea_reference.travel import Course, reach
from tests.fea_reference.cantilever import cantilever, force

HINGE = Path(__file__).parents[2] / "comparisons" / "cases" / "hinge.toml"


def dense(model, system):
    """Least eigenvalue of K u = μ M u on what the rows of joints and inextensible elements leave free.

    M by hand: half of both neighbours' lengths on a node's x, y and θ, one on a body's three motions.
    """
    K = system.tangent.matrix.toarray()
    rows = np.concatenate([model.multipliers, model.element_dofs[6]])
    motions = np.setdiff1d(np.arange(model.size), rows)
    M = np.zeros(model.size)
    for beam in model.beams:
        h = model.elements.length[beam.elements]
        M[model.node_dofs[:, beam.nodes]] = 0.5 * (np.append(h, 0.0) + np.insert(h, 0, 0.0))
    M[[dof for body in model.bodies if body.dofs is not None for dof in body.dofs]] = 1.0
    free = null_space(K[np.ix_(rows, motions)])
    return eigvalsh(free.T @ K[np.ix_(motions, motions)] @ free, free.T @ (M[motions][:, None] * free))[0]


@pytest.mark.parametrize("station", [0.201, 0.67])
def test_of_the_hinge(station):
    """Two beams, a free body that two joints share, open and closed."""
    scene = read(HINGE)
    settings = Settings(elements=12, kinematics="bending", penetration=1e-2)
    model = build(scene, settings)
    march = begin(model, settings, contacts(scene, model, settings.penetration))
    reach(march, Course(0, 1.0), station / model.loads[0].unit)
    assert softest(model, march.system).curvature == pytest.approx(dense(model, march.system), rel=1e-3)


@pytest.mark.parametrize(("times", "unstable"), [(0.9, False), (1.1, True), (5.0, True), (10.0, True), (30.0, True)])
@pytest.mark.parametrize("elements", [20, 2560])
def test_a_column_beyond_eulers_loads(times, unstable, elements):
    """A clamped column with a free end buckles at π² EI/(4 L²); its straight state is in equilibrium beyond, too."""
    model = build(cantilever(force(-1, 0), (1.0,)), Settings(elements=elements, kinematics="bending"))
    pushed = times * np.pi**2 / 4.0  # in EI/L²
    z = model.start.values.copy()
    z[model.element_dofs[6]] = -pushed
    z[[joint.rows[0] for joint in model.joints]] = -pushed, pushed
    system = assemble(model, {}, 6, np.array([pushed]), State.of(z), model.initial_constraints)
    assert np.abs(system.residual).max() < 1e-9 * pushed
    got = softest(model, system).curvature
    assert (got < 0.0) == unstable
    if elements == 20:
        expected = dense(model, system)
        assert (expected < 0.0) == unstable
        assert got == pytest.approx(expected, rel=0.15 if unstable else 1e-3)


def test_the_softest_of_beams_that_know_nothing_of_each_other_is_the_longest():
    """Clamped at both ends, each with curvatures of its own over its length squared: the others do not move at all.

    They are so nearly as long that Lanczos' method has to tell five curvatures within 15 %.
    """
    lengths = [1.0, 0.97, 0.99, 0.95, 0.98, 0.96]
    points = {f"{end}{k}": [x, 0.31 * k] for k, length in enumerate(lengths) for end, x in (("A", 0.0), ("B", length))}
    strip = {"thickness": 0.0113, "width": 0.02, "material": "m"}
    beams = {
        f"beam{k}": {
            **strip,
            "curve": {"kind": "line", "start": points[f"A{k}"], "end": points[f"B{k}"]},
            "start": {"joint": "weld", "point": f"A{k}"},
            "end": {"joint": "weld", "point": f"B{k}"},
        }
        for k in range(len(lengths))
    }
    scene = scene_from(
        {
            "name": "six",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": 2.1e9, "poisson_ratio": 0.3}},
            "bodies": {"ground": {"motion": "fixed", "points": points}},
            "beams": beams,
            "loads": {"P": {"kind": "beam_force", "beam": "beam0", "at": 0.37, "direction": [0.0, -1.0]}},
            "stages": [{"name": "load", "steps": "P", "stations": [1.0]}],
            "probes": [{"of": "beam0", "quantity": "bending_stress", "points": 3}],
        }
    )
    model = build(scene, Settings(elements=7, kinematics="bending"))
    system = assemble(model, {}, 6, np.array([0.0]), model.start, model.initial_constraints)
    mode = softest(model, system)
    assert mode.curvature == pytest.approx(dense(model, system), rel=1e-6)
    longest, *others = (np.abs(mode.direction[model.node_dofs[:, beam.nodes]]).max() for beam in model.beams)
    assert max(others) < 1e-4 * longest
