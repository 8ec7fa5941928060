"""Names of the packages, at commit 3c78333 and today."""

from dataclasses import astuple, dataclass


@dataclass(frozen=True)
class Packages:
    """The five packages; two of the names differ at 3c78333."""

    scene: str = "cprbm_scene"
    exact: str = "elastica_reference"

    @property
    def all(self) -> tuple[str, ...]:
        """The names of the five packages."""
        return (*astuple(self), "cprbm", "fea_reference", "comparisons")
