"""The exact answer where one is known; so far of no scene."""

from __future__ import annotations

from dataclasses import dataclass

from frozendict import frozendict

from scene import Answer, Ending, Scene


@dataclass(frozen=True, slots=True)
class Settings:
    """There is nothing to choose yet."""


def answer(scene: Scene, settings: Settings) -> Answer:
    """That no exact answer is known."""
    return Answer("exact", scene.name, frozendict(), Ending.NOT_COVERED, f"{scene.name} has none.", ())
