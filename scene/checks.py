"""What ties the records together."""

from scene.mistakes import Mistake
from scene.statement import Scene


def mistakes_in(scene: Scene) -> list[Mistake]:
    return []
