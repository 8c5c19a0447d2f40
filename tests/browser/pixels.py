"""Where the 3D view shows what, for a pointer."""

import numpy as np
import viser
from playwright.sync_api import Page

from studio.engine.skeleton import FloatArray


def pixel(server: viser.ViserServer, page: Page, point: FloatArray) -> FloatArray:
    """Return where a point (3,) [m] of the world is on the only browser's page (2,) [px]."""
    (client,) = server.get_clients().values()
    eye, at = np.array(client.camera.position), np.array(client.camera.look_at)
    ahead = (at - eye) / np.linalg.norm(at - eye)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    line = point - eye
    box = page.locator("canvas").first.bounding_box()
    assert box is not None
    scale = box["height"] / 2.0 / np.tan(client.camera.fov / 2.0) / (line @ ahead)
    middle = np.array([box["x"] + box["width"] / 2.0, box["y"] + box["height"] / 2.0])
    return middle + scale * np.array([line @ right, -(line @ np.cross(right, ahead))])


def drag(
    page: Page, start: FloatArray, target: FloatArray, steps: int = 10, pause: float = 200.0
) -> None:
    """Press at one pixel (2,), go to another in steps ``pause`` [ms] apart, and let go there."""
    page.mouse.move(*start)
    page.mouse.down()
    for share in np.linspace(1.0 / steps, 1.0, steps):
        page.mouse.move(*(start + share * (target - start)))
        page.wait_for_timeout(pause)
    page.mouse.up()
