"""Where the camera stands: further away when more stands beside the robot, so that all is seen."""

import math
from dataclasses import dataclass

import viser

from studio.engine.snapshot import Snapshot

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class View:
    """A place of the camera, and what it looks at [m], in the world."""

    position: Triple
    look_at: Triple

    @property
    def distance(self) -> float:
        """How far the camera is from what it looks at [m]."""
        return math.dist(self.position, self.look_at)


ALONE = View((3.6, 0.75, 1.95), (0.25, -0.34, 0.84))
RIGHT_HAND = View((4.4, 0.7, 2.15), (0.25, -0.42, 0.82))  # of the person, who stands to the left
WITH_ONE = View((6.5, 1.7, 2.5), (0.2, 0.6, 0.75))  # a second robot, or a board
WITH_BOTH = View((8.7, 2.6, 3.0), (0.2, 1.4, 0.7))


class Viewpoint:
    """Moves cameras back when something comes, and leaves them there when that goes.

    One that is as far away already stays where its user has it.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._server, self._view = server, ALONE

    def draw(self, now: Snapshot) -> None:
        """Look at what there is."""
        view = view_of(now)
        if view == self._view:
            return
        is_wider = view.position[0] > self._view.position[0]
        self._view = view
        initial = self._server.initial_camera  # of whoever comes, and of "reset view"
        initial.position, initial.look_at = view.position, view.look_at
        for client in self._server.get_clients().values() if is_wider else ():
            if math.dist(client.camera.position, view.look_at) < 0.98 * view.distance:
                client.camera.position = view.position
                client.camera.look_at = view.look_at


def view_of(now: Snapshot) -> View:
    """Return the view that shows all there is."""
    beside = (now.compare.beside is not None, now.compare.field is not None)
    alone = RIGHT_HAND if "right" in now.choices.persons_sides else ALONE
    return (alone, WITH_ONE, WITH_BOTH)[sum(beside)]
