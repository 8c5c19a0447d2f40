"""Whoever was chosen last teaches; without anybody the cure is said."""

from pathlib import Path

import pytest

from studio.engine.errors import StudioError
from studio.engine.live.source import LiveSource
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.recording import from_skeletons
from studio.engine.who_teaches import WhoTeaches
from tests.engine.people import stand


def test_nobody_is_chosen_at_first() -> None:
    who = WhoTeaches(0, None)
    assert (who.chosen, who.status(), who.live(None)) == (None, None, None)
    with pytest.raises(StudioError, match="Choose a source first"):
        who.required()


def test_the_demonstrator_shows_another_take_each_time() -> None:
    who = WhoTeaches(3, None)
    for take in (1, 2):
        assert who.use_demonstrator().startswith(f"Source: demonstrator:{take}")
        expected = demonstrate(3, take)
        assert who.required().skeleton.positions.tobytes() == expected[0].positions.tobytes()


def test_a_file_is_known_by_the_users_name_and_says_if_it_has_no_signs() -> None:
    who = WhoTeaches(0, None)
    path = str(Path("uploads") / "x81231")
    words = who.use_stream(from_skeletons(stand(), path, "test"), "my take.json")
    assert words == "Source: my take.json, 60 frames: it tells no hand states, so open the gate"
    assert who.status().name == "my take.json"


def test_live_streams_can_be_chosen_where_there_are_any() -> None:
    with pytest.raises(StudioError, match="listener"):
        WhoTeaches(0, None).use_live()
    who = WhoTeaches(0, LiveSource(lambda: 0.0))
    assert "Nobody sends yet" in who.use_live()
    assert who.status().is_live
    assert who.live(who.chosen) is not None
