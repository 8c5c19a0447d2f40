from dataclasses import replace
from pathlib import Path

import pytest

from studio.engine.export import Job, Material, StoppedError
from studio.engine.resources import notice_path
from studio.panels.replay_page import REPLAY, replay_page
from tests.engine.export.materials import done, listed

PLAIN = 0.02  # [m] the robot's detail


def short(material: Material) -> Material:
    """Return the material with a second of the reproduction."""
    whole = material.reproduction.performance
    performance = replace(whole, ticks=whole.ticks[40:70])
    return replace(material, reproduction=replace(material.reproduction, performance=performance))


def page(material: Material, job: Job) -> bytes:
    ghost = material.takes[0].demonstration
    return replay_page(material.lesson, material.reproduction, ghost, job, PLAIN)


def test_a_page_is_one_file_that_loads_nothing(tmp_path: Path) -> None:
    shares: list[float] = []
    found = page(short(done()), Job(tmp_path, lambda share: shares.append(share) or True))
    assert found.lstrip()[:9].lower() == b"<!doctype"
    assert b'src="http' not in found
    assert b'href="http' not in found
    text = found.decode()
    comment = text[text.index("<!--") : text.index("-->")]
    assert notice_path().read_text() in comment
    assert text.index("-->") < text.index("</head>")
    assert "<title>Viser</title>" not in text
    assert shares == sorted(shares)
    assert len(shares) > 25


def test_more_ticks_make_a_larger_page(tmp_path: Path) -> None:
    """What moves is in it: the meshes, which are most of it, are there once."""
    some = short(done())
    performance = some.reproduction.performance
    still = replace(performance, ticks=performance.ticks[:1])
    one = replace(some, reproduction=replace(some.reproduction, performance=still))
    assert 1000 < len(page(some, Job(tmp_path))) - len(page(one, Job(tmp_path))) < 400_000


def test_it_can_be_stopped(tmp_path: Path) -> None:
    with pytest.raises(StoppedError):
        page(short(done()), Job(tmp_path, lambda share: share < 0.5))


def test_it_says_what_is_missing() -> None:
    assert "Train first" in REPLAY.lacks(listed())
    assert not REPLAY.lacks(done())
