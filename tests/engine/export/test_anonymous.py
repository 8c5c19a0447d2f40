"""No name survives: all that is exported is unpacked, and searched byte by byte."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

from studio.engine.export import Job, Material, Take, export
from studio.engine.export.anonymous import anonymous
from studio.engine.mcap_log import MAGIC, LogReader
from studio.engine.recording import Recording
from studio.engine.teaching import learn
from tests.engine.export.materials import done

SECRETS = ("Zebedee", "zanzibar-7", "xylophone", "body-quux", "wolfgang")
KINDS = ("csv", "npz", "mcap", "model", "zip")


def named(recording: Recording, number: int) -> Recording:
    """Return a recording that names people and places wherever it can."""
    info = replace(recording.info, source=f"/home/Zebedee/zanzibar-7/{number}.mcap (xylophone)")
    samples = tuple(
        sample
        if sample.skeleton is None
        else replace(sample, skeleton=replace(sample.skeleton, body_id="body-quux"))
        for sample in recording.samples
    )
    return Recording(info, samples, warning="Zebedee's disk was full")


@pytest.fixture(scope="module")
def material() -> Material:
    takes = tuple(
        Take(replace(take.demonstration, name=f"wolfgang {i}"), named(take.recording, i))
        for i, take in enumerate(done("rbf", 10, 2).takes)
    )
    before = replace(done("rbf", 10, 2), takes=takes, lesson=None)
    return replace(before, lesson=learn(before.taught, before.setup.learner))


def unpacked(path: Path) -> Iterator[bytes]:
    """Yield all that is in a file, packed or not."""
    content = path.read_bytes()
    yield content
    if content.startswith(b"PK"):
        with ZipFile(path) as archive:
            for name in archive.namelist():
                yield name.encode()
                inner = path.with_name(f"inner-{Path(name).name}")
                inner.write_bytes(archive.read(name))
                yield from unpacked(inner)
    if content.startswith(MAGIC):
        with path.open("rb") as file:
            log = LogReader(file, len(content), 1 << 30)
            yield repr(list(log)).encode()
            assert not log.problem
            yield repr(log.metadata).encode()


def everything(folder: Path) -> bytes:
    found = b"\n".join(part for path in list(folder.iterdir()) for part in unpacked(path))
    return found + found.replace(b"\0", b"")  # NumPy writes letters four bytes each


def test_no_name_is_in_any_byte(material: Material, tmp_path: Path) -> None:
    for folder, is_anonymous in ((tmp_path / "named", False), (tmp_path / "nameless", True)):
        export(material, KINDS, Job(folder), anonymous=is_anonymous)
        found = everything(folder)
        for secret in SECRETS:
            there = re.search(secret.encode(), found, re.IGNORECASE) is not None
            # Warnings are never written; all others are found where names are kept.
            assert there == (not is_anonymous), secret


def test_only_names_are_gone(material: Material) -> None:
    found = anonymous(material)
    assert [take.demonstration.name for take in found.takes] == [
        "demonstration 1",
        "demonstration 2",
    ]
    assert [each.name for each in found.lesson.taught.demonstrations] == [
        "demonstration 1",
        "demonstration 2",
    ]
    assert [each.info.source for each in found.recordings] == ["recording 1", "recording 2"]
    assert found.learned_from == (0, 1)
    for before, after in zip(material.takes, found.takes, strict=True):
        assert np.array_equal(after.demonstration.sent, before.demonstration.sent)
        for old, new in zip(before.recording.samples, after.recording.samples, strict=True):
            assert new.time == old.time
            assert new.gate == old.gate
            if old.skeleton is not None:
                assert np.array_equal(new.skeleton.positions, old.skeleton.positions)
                assert new.skeleton.body_id == "1"


def test_two_bodies_stay_two(material: Material) -> None:
    take = material.takes[0]
    samples = list(take.recording.samples)
    other = next(i for i, sample in enumerate(samples) if sample.skeleton is not None)
    samples[other] = replace(
        samples[other], skeleton=replace(samples[other].skeleton, body_id="another")
    )
    mixed = replace(take, recording=Recording(take.recording.info, tuple(samples)))
    found = anonymous(replace(material, takes=(mixed,), lesson=None)).takes[0].recording
    assert {s.skeleton.body_id for s in found.samples if s.skeleton is not None} == {"1", "2"}
