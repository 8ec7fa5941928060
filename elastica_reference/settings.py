"""Numerical settings of the exact solution."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field


class Settings(BaseModel):
    """Accuracy of the solution of the differential equations.

    Attributes:
        nodes: Gauss points of a piece of a beam.
        further: additional Gauss points for the check of the result.
        tolerance: largest dimensionless residual of an equilibrium, with either number of points.
        largest_step: largest step of the load or drive, as a fraction of the distance between two stations.
        smallest_step: smallest such step.
        steps: largest number of steps between two stations.
        iterations: largest number of Newton iterations of an equilibrium.
    """

    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)

    nodes: Annotated[int, Field(ge=8, le=96)] = 32
    further: Annotated[int, Field(ge=4, le=96)] = 16
    tolerance: Annotated[float, Field(gt=0.0, le=1e-6)] = 1e-10
    largest_step: Annotated[float, Field(gt=0.0, le=1.0)] = 0.5
    smallest_step: Annotated[float, Field(gt=0.0, le=1.0)] = 1e-4
    steps: Annotated[int, Field(ge=1)] = 100
    iterations: Annotated[int, Field(ge=4)] = 15

    def plain(self) -> dict[str, object]:
        """The settings as plain values for the answer sheet."""
        return self.model_dump(mode="json")
