"""What commands are made of. Written by docs/make_remote_schema.py: change it there."""

from typing import Literal

from studio.remote.message import Part


class LearnerSettings(Part, frozen=True):
    """Which network, and of how many neurons."""

    name: Literal["rbf", "newrb", "field", "plain-field"] = "rbf"
    neurons: int = 50


class HandOptions(Part, frozen=True):
    """What the hands are to do."""

    gripper: bool = False  # fingers on both hands; the person's right hand works those of each arm
    wrist: Literal["zero", "level", "follow"] = "zero"


class Calibration(Part, frozen=True):
    """Which way is down, in the torso's frame of this person before this sensor."""

    down: tuple[float, float, float]  # unit vector


class Choices(Part, frozen=True):
    """How Baxter is taught; by default as at every start."""

    arms: Literal["left", "right", "both"] = "left"
    mapping: Literal["exact", "paper"] = "exact"
    gate: Literal["sequence", "open"] = "sequence"
    mirrored: bool = False  # the robot as in a mirror: its left arm does what the right one does
    hands: HandOptions = HandOptions()
    calibration: Calibration | None = None
