"""What a robot's motors are told each tick, for targets that may move or jump.

A target that moves no faster than its joint can is passed on with its velocity. One that jumps
is approached along a trapezoid: speed up, go on at the joint's top speed, brake. A motor that was
told the jump itself would brake harder than its effort allows, and push other joints beyond their
speeds.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from studio.engine.robot import CONTROL_PERIOD
from studio.engine.skeleton import FloatArray

ACCELERATION = 8.0  # [rad/s²] after a jump; with 15 the other joints are pushed too fast
_ROUNDING = 1e-9  # of a tick's way: a target that moves exactly at top speed does not jump


@dataclass(frozen=True, eq=False)
class Setpoint:
    """What N motors are told, and the memory of the next tick."""

    positions: FloatArray  # (N,) [rad] to be reached when the tick ends
    velocities: FloatArray  # (N,) [rad/s] on the way there
    catching_up: NDArray[np.bool_]  # (N,) on the way to a target that jumped


@dataclass(frozen=True, eq=False)
class Servo:
    """The way from targets to setpoints, within top speeds (N,) [rad/s]."""

    top_speed: FloatArray

    @cached_property
    def _reach(self) -> FloatArray:
        """How far a target that does not jump moves in a tick (N,) [rad]."""
        return self.top_speed * CONTROL_PERIOD * (1 + _ROUNDING)

    def start(self, positions: FloatArray) -> Setpoint:
        """Return the setpoint of a robot at rest at ``positions`` (N,) [rad]."""
        return Setpoint(positions, np.zeros_like(positions), np.zeros(len(positions), dtype=bool))

    def step(self, before: Setpoint, targets: FloatArray) -> Setpoint:
        """Return the next setpoint on the way to ``targets`` (N,) [rad]."""
        way = targets - before.positions
        distance = np.abs(way)
        catching_up = before.catching_up | (distance > self._reach)
        if not catching_up.any():  # what follows comes to the same, and takes three times as long
            return Setpoint(targets, way / CONTROL_PERIOD, catching_up)
        gaining = np.maximum(np.sign(way) * before.velocities, 0) + ACCELERATION * CONTROL_PERIOD
        braking = np.sqrt(2 * ACCELERATION * distance)
        speed = np.minimum(np.minimum(gaining, braking), self.top_speed)
        move = np.where(
            catching_up, np.sign(way) * np.minimum(speed * CONTROL_PERIOD, distance), way
        )
        arrived = np.abs(move) == distance
        positions = np.where(arrived, targets, before.positions + move)
        return Setpoint(positions, move / CONTROL_PERIOD, catching_up & ~arrived)
