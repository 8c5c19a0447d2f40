"""Recordings as MCAP files: whole, or the stretch of one that is a demonstration."""

from dataclasses import replace
from pathlib import Path

from studio.engine.demonstration import Demonstration
from studio.engine.export.kind import Job
from studio.engine.export.material import Material
from studio.engine.mcap_file import write_recording
from studio.engine.recording import Recording
from studio.engine.sources.whole_file import written_whole


def write(material: Material, job: Job) -> tuple[Path, ...]:
    """Write every recording that a demonstration is from."""
    paths = []
    for number, recording in enumerate(material.recordings, start=1):
        paths.append(job.folder / f"recording-{number:03d}.mcap")
        write_whole(paths[-1], recording)
        job.done(number / len(material.recordings))
    return tuple(paths)


def write_whole(path: Path, recording: Recording) -> None:
    """Write a recording in the place of an older file, if there is one.

    Raises
    ------
    FileError
        Where the file cannot be written.
    """
    with written_whole(path) as unfinished:
        unfinished.unlink(missing_ok=True)  # of an export that was killed
        write_recording(unfinished, recording)


def stretch_of(recording: Recording, demonstration: Demonstration) -> Recording:
    """Return the part of a recording that a demonstration is, its time from 0.

    A demonstration that was not trimmed is found in it again, the same to the bit.
    """
    samples = recording.samples[demonstration.first_sample : demonstration.last_sample + 1]
    begin = samples[0].time
    return Recording(
        recording.info, tuple(replace(sample, time=sample.time - begin) for sample in samples)
    )
