"""The first step says who teaches, and draws every state."""

from dataclasses import replace

import viser

from studio.engine.live.status import LiveStatus
from studio.engine.uploads import Uploads
from studio.panels.arcs import ArcsView
from studio.panels.source import SourcePanel, described, sample_files


def test_the_source_in_words(lesson) -> None:
    assert "Who teaches?" in described(lesson["start"])
    assert "demonstrator:1" in described(lesson["sourced"])
    assert "with hand states" in described(lesson["sourced"])


def test_every_state_is_drawn(lesson) -> None:
    server, kept = viser.ViserServer(host="127.0.0.1", port=0, verbose=False), Uploads()
    try:
        panel = SourcePanel(server.gui, lambda _: None, kept, ArcsView(server.scene), lambda: True)
        for now in lesson.values():
            panel.draw(now)
            assert not panel._sensor.visible
        panel.draw(replace(now, live=LiveStatus(address="ws://127.0.0.1:8765")))
        assert panel._sensor.visible
        assert "studio webcam" in panel._how.content
    finally:
        kept.close()
        server.stop()


def test_samples_are_there() -> None:
    assert len(sample_files()) >= 4
