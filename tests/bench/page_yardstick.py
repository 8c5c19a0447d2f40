"""The yardstick of `bench_page`: the script that a viser user writes to show Baxter.

Nothing of the studio's is imported, or it would be as slow to start.
"""

import math
import sys
from importlib.metadata import distribution
from pathlib import Path

import numpy as np
import viser
import yourdfpy
from viser.extras import ViserUrdf

CAMERA = (3.6, 0.75, 1.95), (0.25, -0.34, 0.84)  # [m] where from and where to, the studio's own
BASE_HEIGHT = 0.924  # [m] of Baxter's base over the floor
NEURONS = 17  # what the number field holds of a page that is loaded anew


def minimal(camera: tuple[tuple[float, ...], ...] = CAMERA) -> viser.ViserServer:
    """Serve Baxter."""
    server = looking(camera)
    server.scene.add_frame("/robot", show_axes=False, position=(0.0, 0.0, BASE_HEIGHT))
    robot = ViserUrdf(server, upstream(), root_node_name="/robot")
    robot.update_cfg(np.zeros(len(robot.get_actuated_joint_names())))
    return server


def with_a_field() -> viser.ViserServer:
    """Serve Baxter, and one number field."""
    server = minimal()
    server.gui.add_number("Neurons", NEURONS)
    return server


def looking(camera: tuple[tuple[float, ...], ...]) -> viser.ViserServer:
    """Serve an empty page, seen from a camera."""
    server = viser.ViserServer("127.0.0.1", 0, verbose=False)
    server.initial_camera.position, server.initial_camera.look_at = camera
    server.initial_camera.fov = math.radians(43.0)
    return server


def upstream() -> yourdfpy.URDF:
    """Return the robot as its maker describes it, from the package that carries it."""
    wheel = distribution("example-robot-data")
    file = next(f for f in wheel.files or () if f.parts[-2:] == ("urdf", "baxter.urdf"))
    path = Path(str(wheel.locate_file(file))).resolve()
    share = path.parents[4]
    return yourdfpy.URDF.load(
        str(path), filename_handler=lambda fname: str(share / fname.removeprefix("package://"))
    )


if __name__ == "__main__":
    page = {"minimal": minimal, "field": with_a_field}[sys.argv[1]]()
    print(f"http://127.0.0.1:{page.get_port()}", flush=True)
    sys.stdin.read()
