"""No name survives: all that is exported is unpacked, and searched byte by byte."""

import base64
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest
import zstandard

from studio.engine.export import Job, Material, Take, export, report_page, video
from studio.engine.export.anonymous import anonymous
from studio.engine.mcap_log import MAGIC, LogReader
from studio.engine.recording import Recording
from studio.engine.teaching import learn, reproduce
from studio.panels.replay_page import replay_page
from tests.engine.export.materials import done
from tests.panels.conftest import mesh_folder  # noqa: F401 - not the user's own cache

SECRETS = ("Zebedee", "zanzibar-7", "xylophone", "body-quux", "wolfgang")
KINDS = ("csv", "npz", "mcap", "model", "html", "zip")
PLAIN = 0.02  # [m] the replayed robot's detail
_SCENE = re.compile(rb'__VISER_EMBED_DATA__="([^"]+)"')  # in a replay: its size, then zstd


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
    for scene in _SCENE.findall(content):
        yield zstandard.ZstdDecompressor().decompressobj().decompress(base64.b64decode(scene)[8:])


def everything(folder: Path) -> bytes:
    found = b"\n".join(part for path in list(folder.iterdir()) for part in unpacked(path))
    return found + found.replace(b"\0", b"")  # NumPy writes letters four bytes each


def test_no_name_is_in_any_byte(
    material: Material, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(report_page, "DEFAULT_LEARNERS", ("rbf",))  # others only take longer
    for folder, is_anonymous in ((tmp_path / "named", False), (tmp_path / "nameless", True)):
        export(material, KINDS, Job(folder), anonymous=is_anonymous)
        found = everything(folder)
        for secret in SECRETS:
            there = re.search(secret.encode(), found, re.IGNORECASE) is not None
            # Warnings are never written; all others are found where names are kept.
            assert there == (not is_anonymous), secret


@pytest.fixture(scope="module")
def done_alone(material: Material) -> Material:
    """Return the material with the first second of a reproduction."""
    whole = reproduce(material.lesson)
    performance = replace(whole.performance, ticks=whole.performance.ticks[:30])
    return replace(material, reproduction=replace(whole, performance=performance))


@pytest.mark.parametrize("is_anonymous", [False, True])
def test_no_name_is_in_the_replay_nor_in_the_film(
    done_alone: Material, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_anonymous: bool
) -> None:
    """They show the name of a demonstration, the film as letters that nobody could search for."""
    shown = anonymous(done_alone) if is_anonymous else done_alone
    ghost = shown.lesson.taught.demonstrations[0]
    page = replay_page(shown.lesson, shown.reproduction, ghost, Job(tmp_path), PLAIN)
    (tmp_path / "replay.html").write_bytes(page)
    titles: list[str] = []

    def film(_path: Path, sides: tuple[video.Side, ...], *_: object) -> int:
        titles.extend(side.title for side in sides)
        return 0

    monkeypatch.setattr(video, "write_film", film)
    export(done_alone, ["video"], Job(tmp_path), anonymous=is_anonymous)
    assert titles == [
        f"Demonstration: {'demonstration 1' if is_anonymous else 'wolfgang 0'}",
        "Alone: rbf, 50 neurons",
    ]
    found = everything(tmp_path)
    assert b"ghost: " in found
    for secret in SECRETS:
        there = re.search(secret.encode(), found, re.IGNORECASE) is not None
        assert there == (secret == "wolfgang" and not is_anonymous), secret


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
