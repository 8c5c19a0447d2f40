"""What the exports' tests share: the shipped demonstrations, learned and done alone."""

from dataclasses import replace
from functools import cache

from studio.engine.experiment import Setup
from studio.engine.export.material import Material, material_of
from studio.engine.resources import samples_folder
from studio.engine.teaching import LearnerName, LearnerSettings, learn, reproduce


@cache
def listed(count: int = 4) -> Material:
    """Return shipped demonstrations, nothing learned."""
    return material_of(sorted(samples_folder().glob("*.mcap"))[:count], Setup())


@cache
def done(learner: LearnerName = "rbf", neurons: int = 50, count: int = 4) -> Material:
    """Return the same with what was learned, and what Baxter did alone."""
    material = listed(count)
    lesson = learn(material.taught, LearnerSettings(learner, neurons))
    return replace(material, lesson=lesson, reproduction=reproduce(lesson))
