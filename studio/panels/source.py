"""1 Source: who teaches (a sample, a file, the demonstrator, a live stream), and how."""

from pathlib import Path

import viser

from studio.engine import commands
from studio.engine.errors import FileError
from studio.engine.resources import samples_folder
from studio.engine.snapshot import Snapshot, SourceStatus
from studio.panels import markup, streams
from studio.panels.calibration import CalibrationPanel
from studio.panels.inputs import Post
from studio.panels.settings import SettingsPanel
from studio.panels.uploads import Uploads, shown_name


class SourcePanel:
    """The first step."""

    def __init__(self, gui: viser.GuiApi, post: Post, uploads: Uploads) -> None:
        self._post, self._uploads = post, uploads
        self._now = gui.add_html("")
        self._add_sources(gui)
        self._add_live(gui)
        self._problem = gui.add_html("", visible=False)
        gui.add_divider()
        gui.add_html(markup.block("<b>How Baxter follows</b>"))
        self._settings = SettingsPanel(gui, post)
        gui.add_divider()
        self._calibration = CalibrationPanel(gui, post)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._now.content = described(now.source)
        self._take_live.visible = self._live.visible = now.live is not None
        self._live.content = streams.described(now.live)
        self._settings.draw(now)
        self._calibration.draw(now)

    def _add_sources(self, gui: viser.GuiApi) -> None:
        demonstrator = gui.add_button(
            "Take the demonstrator",
            hint="A built-in person who signs and pushes the block; each take differs a little",
            icon=viser.Icon.USER,
        )
        demonstrator.on_click(lambda _: self._post(commands.UseDemonstrator()))
        samples = sample_files()
        if samples:
            self._sample = gui.add_dropdown("Sample", tuple(samples))
            load = gui.add_button("Take the sample", icon=viser.Icon.FILE)
            load.on_click(lambda _: self._post(commands.UseFile(samples[self._sample.value])))
        upload = gui.add_upload_button(
            "Upload a file",
            hint="Skeletons (Kinect, NTU RGB+D, MediaPipe, tables, JSONL) or a recording (MCAP)",
            icon=viser.Icon.UPLOAD,
        )
        upload.on_upload(self._receive)

    def _add_live(self, gui: viser.GuiApi) -> None:
        self._take_live = gui.add_button(
            "Take the live stream",
            hint="Whoever sends: a webcam, a Kinect's program, a recording that is played",
            icon=viser.Icon.BROADCAST,
            visible=False,
        )
        self._take_live.on_click(lambda _: self._post(commands.UseLive()))
        self._live = gui.add_html("", visible=False)

    def _receive(self, event: viser.GuiEvent[viser.GuiUploadButtonHandle]) -> None:
        file = event.target.value
        try:
            path = self._uploads.keep(file.name, file.content)
        except FileError as error:
            self._problem.content, self._problem.visible = markup.problem(str(error)), True
        else:
            self._problem.visible = False
            self._post(commands.UseFile(path, shown_name(file.name)))


def sample_files() -> dict[str, Path]:
    """Return what ships with the studio, under names that tell what it does."""
    files = sorted(samples_folder().glob("*"))
    shown = {".mcap": "recording", ".jsonl": "skeletons"}
    return {f"{f.stem} ({shown[f.suffix]})": f for f in files if f.suffix in shown}


def described(source: SourceStatus | None) -> str:
    """Return the source in words."""
    if source is None:
        return markup.block("<b>No source yet.</b> Who teaches?")
    if source.is_live:
        return markup.block(f"Source: <b>{markup.text(source.name)}</b>, until Stop")
    hands = "with hand states" if source.has_hand_states else "without hand states: open the gate"
    figures = f"{source.frames} frames, {source.seconds:.1f} s, {hands}"
    return markup.block(f"Source: <b>{markup.text(source.name)}</b><br>{markup.text(figures)}")
