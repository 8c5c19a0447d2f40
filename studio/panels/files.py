"""A file of the user's own: how it comes in, how far it is read, and who is followed in it."""

import viser

from studio.engine import commands
from studio.engine.errors import FileError
from studio.engine.reading import ReadingStatus
from studio.engine.snapshot import Snapshot
from studio.engine.uploads import LARGEST, Uploads, shown_name
from studio.panels import markup
from studio.panels.inputs import Post, on_choice, show_value

NEAREST = "nearest to the sensor"


class ReadingPanel:
    """A part of the first step: how far a file is read, wherever it came from."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._words = gui.add_html("", visible=False)
        self._bar = gui.add_progress_bar(0.0, visible=False)
        self._cancel = gui.add_button("Give up reading", color="gray", visible=False)
        self._cancel.on_click(lambda _: post(commands.CancelReading()))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        reading = now.who.reading
        for part in (self._words, self._bar, self._cancel):
            part.visible = reading is not None
        if reading is not None:
            self._words.content = described(reading)
            self._bar.animated = reading.share is None
            share = 1.0 if reading.share is None else reading.share
            self._bar.value = 100.0 * share  # type: ignore[misc] # as in `show_value`


class FilePanel:
    """A part of the first step: the upload, and whom to follow in a file."""

    def __init__(self, gui: viser.GuiApi, post: Post, uploads: Uploads) -> None:
        self._post, self._uploads = post, uploads
        self._ids: dict[str, str | None] = {}  # of the bodies, by what the dropdown shows
        self._drawn: object = None
        upload = gui.add_upload_button(
            "Upload a file",
            hint="Skeletons (Kinect, NTU RGB+D, MediaPipe, tables, JSONL) or a recording (MCAP), "
            f"up to {LARGEST // 2**20} MB",
            icon=viser.Icon.UPLOAD,
            color="gray",
        )
        upload.on_upload(self._receive)
        self._problem = gui.add_html("", visible=False)
        self._body = gui.add_dropdown("Follow", (NEAREST,), visible=False)
        on_choice(self._body, lambda: post(commands.FollowBody(self._ids.get(self._body.value))))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        if now.who.reading is not None:
            self._problem.visible = False
        self._body.visible = len(now.who.bodies) > 1
        # Only what has changed, or has been refused: a choice just made is on its way.
        state = (now.who.bodies, now.who.body, now.message.number)
        if not self._body.visible or state == self._drawn:
            return
        self._drawn = state
        self._ids = body_labels(now.who.bodies)
        self._body.options = tuple(self._ids)
        chosen = (label for label, each in self._ids.items() if each == now.who.body)
        show_value(self._body, next(chosen, NEAREST))  # who is followed may have left just now

    def _receive(self, event: viser.GuiEvent[viser.GuiUploadButtonHandle]) -> None:
        file = event.target.value
        try:
            path = self._uploads.keep(file.name, file.content)
        except FileError as error:
            self._problem.content, self._problem.visible = markup.problem(str(error)), True
        else:
            self._problem.visible = False
            self._post(commands.UseFile(path, shown_name(file.name)))


def described(reading: ReadingStatus) -> str:
    """Return how far a file is read as HTML."""
    share = "" if reading.share is None else f": {reading.share:.0%}"
    more = f"; {reading.waiting} more to come" if reading.waiting else ""
    return markup.block(f"Reading <b>{markup.text(reading.name)}</b>{share}{more}")


def body_labels(bodies: tuple[tuple[str, int | None], ...]) -> dict[str, str | None]:
    """Return what the dropdown shows for each choice of a body, and its id."""
    labels: dict[str, str | None] = {NEAREST: None}
    for body, frames in bodies:
        labels[f"body {body}" if frames is None else f"body {body} ({frames} frames)"] = body
    return labels
