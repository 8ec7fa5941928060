"""What the error of a method without shear depends on: three materials at one deformation, and Poisson's ratio alone.

======  ==================================================================================
symbol  meaning
======  ==================================================================================
E, ν    Young's modulus, Pa, and Poisson's ratio
E_0     the modulus that a scene's own material has
G       shear modulus, E/(2(1 + ν))
======  ==================================================================================

A scene of one material and dead loads is asked with another material and its loads times E/E_0.  In the bending of
inextensible lines E stands in one place, the stiffness E·I: over it the potential energy is the same function of the
shape for every E, so that shapes, contact and every relative error are the same.  Stretch adds the ratio of E·I to
E·A, which is the section's alone.  Shear adds that of E·I to G·A, that is E/G = 2(1 + ν), which is the material's.

At the end of every stage one station is asked, and it is gone to in one load.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from comparisons import cases
from comparisons.budgets.poisson import with_ratio
from comparisons.choices import Choices, Count, Kinematics
from comparisons.pairing import Solvers, paired
from comparisons.scales import norm
from comparisons.soundness import complaints
from comparisons.stations import station_of
from comparisons.studies.last_loads import at_last_loads
from comparisons.verdict import Comparison, compared
from cprbm_scene import Answer, Claim, Material, Probe, Scene
from cprbm_scene.frozendict import frozendict

MATERIALS: Mapping[str, Material] = frozendict(
    {
        "ABS": Material(youngs_modulus=2.3e9, poisson_ratio=0.35),
        # the paper names the metal alone; usual values of its common alloy, Ti-6Al-4V, to two digits
        "titanium": Material(youngs_modulus=1.1e11, poisson_ratio=0.34),
        "steel": Material(youngs_modulus=2.0e11, poisson_ratio=0.30),
    }
)

POISSON_RATIOS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)
WITHOUT_SHEAR: tuple[Kinematics, ...] = ("bending", "stretch")


@dataclass(frozen=True, slots=True)
class Specimen:
    """A built-in case, the points that sections 3.2 and 3.3 speak of, what they claim, and how finely it is asked."""

    case: str
    displaced: tuple[str, ...]
    bound: float
    links: Count
    elements: Count = 80

    @property
    def choices(self) -> Choices:
        """The discretisation; the paper's own in :data:`SPECIMENS`."""
        return Choices(links=self.links, elements=self.elements)


SPECIMENS = (
    Specimen("hinge", ("B", "D"), 0.008, 40),
    Specimen("gripper", ("A", "B"), 0.0017, frozendict({"beam1": 30, "beam2": 40})),
)


@dataclass(frozen=True, slots=True)
class Tested:
    """A specimen of a material, compared; ``scaled`` is E/E_0."""

    specimen: Specimen
    material: str
    scaled: float
    comparison: Comparison

    def error(self, probe: str, kinematics: Kinematics, *, finer: bool) -> float | None:
        """The CPRBM's error of a probe beside the finite elements in a theory, at n or at 2n of them.

        Raises:
            KeyError: the comparison has no such probe or theory.
        """
        scene, runs = self.comparison.scene, self.comparison.runs
        probes = {each.name: each for each in scene.probes}
        return error_of(scene, probes[probe], runs.cprbm[0], runs.fea[kinematics][int(finer)])

    @property
    def properties(self) -> Material:
        """E and ν."""
        return MATERIALS[self.material]


@dataclass(frozen=True, slots=True)
class Sweep:
    """A specimen's errors in ``shear`` by probe, one for each of ``poisson_ratios``, and in the theories without it.

    An error is |v_c − V_f|/|V_f| at the last station, V_f with twice the elements of the specimen's choices: a zone
    of contact takes in an element more at some ratio, and with few elements the step would be seen.  None where a run
    gave no whole answer.
    """

    specimen: Specimen
    poisson_ratios: tuple[float, ...]
    errors: Mapping[str, tuple[float | None, ...]]
    without_shear: Mapping[str, Mapping[Kinematics, float | None]]


@dataclass(frozen=True, slots=True)
class Materials:
    """All that is measured so far."""

    tested: tuple[Tested, ...] = ()
    sweeps: tuple[Sweep, ...] = ()

    def with_piece(self, piece: Tested | Sweep) -> Materials:
        """The same and one piece more."""
        if isinstance(piece, Tested):
            return Materials((*self.tested, piece), self.sweeps)
        return Materials(self.tested, (*self.sweeps, piece))


Piece = Callable[[Solvers], Tested | Sweep]


def pieces(specimens: tuple[Specimen, ...] = SPECIMENS) -> tuple[Piece, ...]:
    """What is to be measured, each piece a function of the solvers."""
    return (
        *(_testing(specimen, material) for specimen in specimens for material in MATERIALS),
        *(_sweeping(specimen) for specimen in specimens),
    )


def of_material(scene: Scene, material: Material) -> Scene:
    """A scene of one material with another in its place, its loads scaled to the same deformation.

    Raises:
        ValueError: the scene has not one material.
    """
    if len(scene.materials) != 1:
        raise ValueError(f"{scene.name} has {len(scene.materials)} materials; one can be replaced by another")
    ((name, own),) = scene.materials.items()
    factor = material.youngs_modulus / own.youngs_modulus
    stages = tuple(
        stage.model_copy(update={"stations": tuple(factor * value for value in stage.stations)})
        if stage.steps in scene.loads
        else stage
        for stage in scene.stages
    )
    return scene.model_copy(update={"materials": frozendict({name: material}), "stages": stages})


def question(specimen: Specimen) -> Scene:
    """The specimen's displacements and contact forces at the end of every stage, with the claim about each."""
    scene = at_last_loads(cases.opened(specimen.case))
    displaced = tuple(Probe(of=point, quantity="displacement") for point in specimen.displaced)
    forces = tuple(Probe(of=contact, quantity="force") for contact in scene.contacts)
    claims = tuple(Claim(probe=probe.name, bound=specimen.bound) for probe in displaced)
    return scene.model_copy(update={"probes": (*displaced, *forces), "claims": claims})


def _testing(specimen: Specimen, material: str) -> Piece:
    def tested(solvers: Solvers) -> Tested:
        scene = question(specimen)
        (own,) = scene.materials.values()
        scaled = MATERIALS[material].youngs_modulus / own.youngs_modulus
        scene = of_material(scene, MATERIALS[material])
        return Tested(specimen, material, scaled, compared(scene, paired(scene, specimen.choices, solvers)))

    return tested


def _sweeping(specimen: Specimen) -> Piece:
    def swept(solvers: Solvers) -> Sweep:
        scene, choices = question(specimen), specimen.choices
        cprbm = solvers.cprbm(scene, choices)  # ν is not in it
        finer = choices.finer()
        without = {kinematics: solvers.fea(scene, finer.within(kinematics)) for kinematics in WITHOUT_SHEAR}
        fea = [solvers.fea(with_ratio(scene, ratio), finer) for ratio in POISSON_RATIOS]
        probes = [probe for probe in scene.probes if probe.quantity == "displacement"]
        return Sweep(
            specimen,
            POISSON_RATIOS,
            frozendict({probe.name: tuple(error_of(scene, probe, cprbm, each) for each in fea) for probe in probes}),
            frozendict(
                {
                    probe.name: frozendict(
                        {kinematics: error_of(scene, probe, cprbm, each) for kinematics, each in without.items()}
                    )
                    for probe in probes
                }
            ),
        )

    return swept


def error_of(scene: Scene, probe: Probe, cprbm: Answer, fea: Answer) -> float | None:
    """|v_c − v_f|/|v_f| at the last station; None where an answer is not whole."""
    if complaints(scene, cprbm) or complaints(scene, fea):
        return None
    last = scene.stages[-1]
    v_c, v_f = (station_of(each, last.name, last.stations[-1]).values[probe.name] for each in (cprbm, fea))
    size = norm(probe.quantity, v_f)
    return norm(probe.quantity, v_c - v_f) / size if size > 0.0 else None
