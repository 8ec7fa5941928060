"""Elements alone: states that every shape of an element reproduces exactly."""

import numpy as np
import pytest

from fea_reference.solid import Settings
from fea_reference.solid.model import build
from fea_reference.solid.pairs import pairs_of
from fea_reference.solid.system import assemble
from tests.fea_reference.solid.bars import bar, quarter

TAPERED = {"at": [0.0, 0.43, 1.0], "values": [0.021, 0.034, 0.013]}


def model(elements=5):
    """A quarter ring of uneven thickness, in a few curved quadrilaterals."""
    scene = bar(quarter(0.11), TAPERED, poisson=0.35, probes=(("tip", "displacement"),))
    return build(scene, Settings(elements=elements, across=2))


def inner(mesh):
    """Nodes that are on no edge."""
    return (np.abs(mesh.eta) < 1.0 - 1e-9) & (mesh.u > 1e-9) & (mesh.u < 1.0 - 1e-9)


def test_the_area_is_that_of_a_ring_of_varying_thickness():
    # the normals of a circle are radial, so a strip of angle dφ has the area r t dφ whatever t
    one = model(60)
    r, t = 0.11, np.interp(np.linspace(0.0, 1.0, 200_001), TAPERED["at"], TAPERED["values"])
    assert one.mesh.weights.sum() * one.units.length**2 == pytest.approx(
        np.trapezoid(t, dx=1 / 200_000) * r * np.pi / 2, rel=1e-8
    )


def test_patch_an_even_strain_is_held_exactly_by_curved_elements():
    one = model()
    gradient = np.array([[0.013, -0.021], [0.034, 0.008]])
    held = one.strain_elements((one.mesh.places @ gradient.T).ravel())
    assert np.abs(held.F - np.eye(2) - gradient).max() < 1e-13
    forces = np.bincount(one.elements.dofs.ravel(), held.gradient.ravel()).reshape(-1, 2)
    assert np.abs(forces[inner(one.mesh)]).max() < 1e-12 * np.abs(forces).max()


@pytest.mark.parametrize("turn", [0.37, -2.9])
def test_a_rigid_rotation_leaves_no_stress(turn):
    one = model()
    cos, sin = np.cos(turn), np.sin(turn)
    moved = one.mesh.places @ np.array([[cos - 1.0, sin], [-sin, cos - 1.0]])
    held = one.strain_elements(moved.ravel())
    assert np.abs(held.strain).max() < 1e-13
    assert held.determinants == pytest.approx(1.0, abs=1e-13)


def test_forces_and_tangent_are_the_derivatives_of_the_energy():
    # a circle that the thickest place nearly touches
    far, thickest = 0.18, 0.43 * np.pi / 2
    scene = bar(
        quarter(0.11),
        TAPERED,
        poisson=0.35,
        probes=(("wall", "force"),),
        contacts={
            "wall": {
                "kind": "beam-circle",
                "beam": "beam",
                "body": "block",
                "center": [far * np.cos(thickest), far * np.sin(thickest)],
                "radius": far - 0.11 - 0.034 / 2 - 1e-6,
            }
        },
    )
    one = build(scene, Settings(elements=6, across=1))
    pairs = dict.fromkeys(pairs_of(scene, one), 7.0)
    rng = np.random.default_rng(20)
    z, way, load = 3e-3 * rng.normal(size=one.size), rng.normal(size=one.size), np.array([0.7])

    def at(share):
        return assemble(one, pairs, 12, load, z + share * way)  # points of a zone move: their energy must be exact

    here, step = at(0.0), 1e-6
    assert sum(touch.energy for touch in here.touches) > 0.0

    def energy(system):
        part = one.loads[0]
        work = load[0] * part.direction @ one.bodies[part.body].motion(part.arm, system.z)
        return system.strained.energy + sum(touch.energy for touch in system.touches) - work

    slope = (energy(at(step)) - energy(at(-step))) / (2.0 * step)
    assert slope == pytest.approx(here.residual @ way, rel=1e-6)
    change = (at(step).residual - at(-step).residual) / (2.0 * step)
    assert np.abs(change - here.tangent @ way).max() < 1e-6 * np.abs(change).max()
