"""Formats that are known by sight but not read yet, so that the error can call them by name."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class KnownFormat:
    """A format that is recognized and refused."""

    name: str
    recognizes: Callable[[str], bool]  # given the first characters of a text


def is_node_kinect2(head: str) -> bool:
    """Return whether a text looks like node-kinect2's bodies, live or in Kinectron's recording."""
    return head.lstrip()[:1] in ("[", "{") and '"bodyIndex"' in head and '"frames"' not in head


def is_ntu(head: str) -> bool:
    """Return whether a text begins as NTU RGB+D's: frame count, body count, ten fields, joints."""
    lines = [line.split() for line in head.split("\n", 1000)[:-1]]
    first = next((index for index, line in enumerate(lines) if len(line) > 1), None)
    if first is None or first < 2 or not all(len(line) == 1 for line in lines[:first]):
        return False
    numbers = all(line[0].isdecimal() for line in lines[:first])
    return numbers and len(lines[first]) == 10


KNOWN_FORMATS = (
    KnownFormat("a Kinectron or node-kinect2 recording", is_node_kinect2),
    KnownFormat("an NTU RGB+D skeleton file", is_ntu),
)
