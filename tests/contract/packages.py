"""Names of the packages, which commit 3c78333 and today's program do not share."""

from dataclasses import astuple, dataclass


@dataclass(frozen=True)
class Packages:
    """The five packages, those named that have had another name."""

    scene: str = "cprbm_scene"
    exact: str = "elastica_reference"

    @property
    def all(self) -> tuple[str, ...]:
        """Names of all five."""
        return (*astuple(self), "cprbm", "fea_reference", "comparisons")
