"""The same material without anybody's name: of files, of sources, of demonstrations, of bodies.

What is left are motions and numbers. Someone who knows a person may still know how they move.
"""

from dataclasses import replace

from studio.engine.demonstration import Demonstration
from studio.engine.export.material import Material, Take
from studio.engine.recording import Recording, Sample
from studio.engine.teaching import Lesson


def anonymous(material: Material) -> Material:
    """Return the material with neutral names: demonstration 1, recording 1, body 1."""
    recordings = {
        id(recording): _nameless(recording, f"recording {number}")
        for number, recording in enumerate(material.recordings, start=1)
    }
    takes = tuple(
        Take(_renamed(take.demonstration, index), recordings[id(take.recording)], take.included)
        for index, take in enumerate(material.takes)
    )
    lesson = material.lesson
    return replace(
        material, takes=takes, lesson=None if lesson is None else _lesson(material, lesson)
    )


def _lesson(material: Material, lesson: Lesson) -> Lesson:
    known = material.learned_from
    numbers = range(len(lesson.taught.demonstrations)) if known is None else known
    renamed = tuple(
        _renamed(each, index)
        for each, index in zip(lesson.taught.demonstrations, numbers, strict=True)
    )
    return replace(lesson, taught=replace(lesson.taught, demonstrations=renamed))


def _renamed(demonstration: Demonstration, index: int) -> Demonstration:
    return replace(demonstration, name=f"demonstration {index + 1}")


def _nameless(recording: Recording, name: str) -> Recording:
    """Return a recording with neutral names; bodies are numbered as they first appear."""
    seen = [sample.skeleton.body_id for sample in recording.samples if sample.skeleton is not None]
    numbers = {body: str(number) for number, body in enumerate(dict.fromkeys(seen), start=1)}
    samples = tuple(_without_body(sample, numbers) for sample in recording.samples)
    return Recording(replace(recording.info, source=name), samples)


def _without_body(sample: Sample, numbers: dict[str, str]) -> Sample:
    if sample.skeleton is None:
        return sample
    body = numbers[sample.skeleton.body_id]
    return replace(sample, skeleton=replace(sample.skeleton, body_id=body))
