"""The CPRBM solver's numerical choices: nothing here belongs to the physical question."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Literal, cast

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from cprbm_scene import Mistake, Scene
from cprbm_scene.freedoms import FREEDOMS, Freedoms, unsupported
from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import refuse_broken
from cprbm_scene.solving import Requirement, refuse

FEWEST_LINKS = 2


def _frozen(links: dict[str, int]) -> dict[str, int]:
    return cast("dict[str, int]", frozendict(links))


class Settings(BaseModel):
    """How finely and by which contact formulation a scene is solved.

    Attributes:
        links: number of elements N per beam (N springs, N + 1 links), one number or one per beam's name.
        formulation: ``auto`` measures the gap between smooth curves where they are closest;
            ``paper`` constrains related joints against a fitted polynomial or what is rigid, eqs. (8)-(11).
        degree: of the fitted polynomial of ``paper``; lowered to the number of points less one.
        tolerance: largest scaled residual and violation of an equilibrium; round-off may set a higher floor.
        iterations: most Newton iterations of one equilibrium.
        iteration_limit: most Newton iterations of all load steps between two stations.
        largest_turn: most that a link may turn between two accepted load steps, rad.
        smallest_step: smallest load step, as a fraction of the way between two stations.
    """

    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)

    links: int | Annotated[dict[str, int], AfterValidator(_frozen)] = 40
    formulation: Literal["auto", "paper"] = "auto"
    degree: Annotated[int, Field(ge=1, le=8)] = 4
    tolerance: Annotated[float, Field(gt=0.0, le=1e-4)] = 1e-11
    iterations: Annotated[int, Field(ge=1)] = 50
    iteration_limit: Annotated[int, Field(ge=1)] = 3000
    largest_turn: Annotated[float, Field(gt=0.0)] = 1.6
    smallest_step: Annotated[float, Field(gt=0.0, le=1.0)] = 1e-5

    def links_of(self, beam: str) -> int:
        """Number of elements of ``beam``."""
        return self.links if isinstance(self.links, int) else self.links[beam]

    def finer(self) -> Settings:
        """The same with twice the elements."""
        twice = 2 * self.links if isinstance(self.links, int) else _frozen({k: 2 * n for k, n in self.links.items()})
        return self.model_copy(update={"links": twice})

    def plain(self) -> dict[str, object]:
        """The settings as plain values for the answer sheet."""
        return self.model_dump(mode="json")

    def check(self, scene: Scene) -> None:
        """Refuse numbers of links without a beam of ``scene``, and requirements beyond the CPRBM.

        Raises:
            SceneError: a beam has no number, a number has no beam, a number is too small, or the scene
                requires more.
        """
        named: Mapping[str, int] = dict.fromkeys(scene.beams, self.links) if isinstance(self.links, int) else self.links
        known, fewest = " or ".join(scene.beams), f"at least {FEWEST_LINKS} elements per beam"
        wrong = [(beam, "no such beam", known) for beam in named if beam not in scene.beams]
        wrong += [
            (beam, str(named.get(beam, "nothing")), fewest) for beam in scene.beams if named.get(beam, 0) < FEWEST_LINKS
        ]
        refuse_broken(
            *(Mistake(f"settings.links.{beam}", found, allowed, scene.file) for beam, found, allowed in wrong)
        )
        met: tuple[Requirement, ...] = ("overlap at rest", "edge", "from", "together")
        if scene.contacts and self.formulation == "auto" and all(_unsupported_parts(scene)):
            # contacts may hold every part without support
            met += ("support",)
        refuse(scene, "the CPRBM", *met)


def loose_bodies(scene: Scene) -> list[str]:
    """Bodies with a single motion that no beam, pin or drive resists: only contacts may hold them."""
    return [name for name in _unsupported_parts(scene) if name]


def _unsupported_parts(scene: Scene) -> Iterator[str]:
    """For every part without support the name of the body, if the part is a body with a single motion, else empty."""
    freedoms = Freedoms(scene)
    for mistake, names in unsupported(freedoms):
        name = mistake.key.removeprefix("bodies.")
        yield name if names == {name} and len(freedoms.guide(name)) == FREEDOMS - 1 else ""
