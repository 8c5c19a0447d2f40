"""Addresses, as people type them."""

import time

import pytest

from studio.engine.errors import StudioError
from studio.engine.links.address import link_at
from studio.engine.links.coppeliasim import CoppeliaSim
from studio.engine.links.rosbridge import Rosbridge
from studio.engine.links.simulated import SimulatedRobot


@pytest.mark.parametrize(
    ("url", "kind", "parts"),
    [
        ("rosbridge://baxter", Rosbridge, {"_host": "baxter", "_port": 9090}),
        ("rosbridge://10.0.0.5:9091", Rosbridge, {"_host": "10.0.0.5", "_port": 9091}),
        ("rosbridge://[::1]:9090", Rosbridge, {"_host": "::1", "_port": 9090}),
        ("coppeliasim://localhost", CoppeliaSim, {"_port": 23000, "_model": "Baxter"}),
        ("coppeliasim://localhost:1/Robbie", CoppeliaSim, {"_port": 1, "_model": "Robbie"}),
        (" simulated:// ", SimulatedRobot, {}),
    ],
)
def test_each_means_a_link(url: str, kind: type, parts: dict[str, object]) -> None:
    link = link_at(url, time.monotonic)
    assert type(link) is kind
    assert {name: getattr(link, name) for name in parts} == parts
    assert link.url == url


@pytest.mark.parametrize(
    "url",
    ["", "localhost", "ros://a", "rosbridge:", "coppeliasim://", "rosbridge://a:99999", "x" * 999],
)
def test_others_are_refused_in_words(url: str) -> None:
    with pytest.raises(StudioError, match="a robot's address is") as refused:
        link_at(url, time.monotonic)
    assert len(str(refused.value)) < 250
