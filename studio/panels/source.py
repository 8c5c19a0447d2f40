"""1 Source: who teaches (the puppet, a sample, a file, a live stream), and how."""

from collections.abc import Callable
from pathlib import Path

import viser

from studio.engine import commands
from studio.engine.resources import samples_folder
from studio.engine.snapshot import Snapshot
from studio.engine.uploads import Uploads
from studio.panels import markup, streams
from studio.panels.arcs import ArcsView
from studio.panels.arm_angles import ArmAnglesPanel
from studio.panels.calibration import CalibrationPanel
from studio.panels.files import FilePanel, ReadingPanel
from studio.panels.inputs import Post
from studio.panels.puppet import PuppetPanel
from studio.panels.robot_link import RobotPanel
from studio.panels.scene_choice import SceneChoice
from studio.panels.settings import SettingsPanel


class SourcePanel:
    """The first step."""

    def __init__(
        self,
        gui: viser.GuiApi,
        post: Post,
        uploads: Uploads,
        arcs: ArcsView,
        may_act: Callable[[], bool],
    ) -> None:
        self._post = post
        self._now = gui.add_html("")
        self._reading = ReadingPanel(gui, post)
        self._puppet = PuppetPanel(gui, post)
        self._add_ready_made(gui)
        self._file = FilePanel(gui, post, uploads)
        with gui.add_folder("What there is to do: the scene", expand_by_default=False):
            self._scene = SceneChoice(gui, post)
        self._sensor = gui.add_folder("A sensor: live stream, webcam", expand_by_default=False)
        with self._sensor:
            self._add_live(gui)
        with gui.add_folder("How Baxter follows", expand_by_default=False):
            self._settings = SettingsPanel(gui, post)
            self._calibration = CalibrationPanel(gui, post)
        with gui.add_folder("Your arm's six angles", expand_by_default=False):
            self._angles = ArmAnglesPanel(gui, arcs)
        with gui.add_folder("A robot beyond the simulator", expand_by_default=False):
            self._robot = RobotPanel(gui, post, may_act)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._now.content = described(now)
        self._reading.draw(now)
        self._puppet.draw(now)
        self._file.draw(now)
        self._scene.draw(now)
        self._sensor.visible = now.live is not None
        self._live.content = streams.described(now.live)
        self._how.content = streams.instructions(now.live)
        self._settings.draw(now)
        self._calibration.draw(now)
        self._angles.draw(now)
        self._robot.draw(now)

    def _add_ready_made(self, gui: viser.GuiApi) -> None:
        """Add who is there without anybody's doing."""
        demonstrator = gui.add_button(
            "Take the demonstrator",
            hint="A built-in person who signs and does the task; each take differs a little",
            icon=viser.Icon.USER,
            color="gray",
        )
        demonstrator.on_click(lambda _: self._post(commands.UseDemonstrator()))
        samples = sample_files()
        if samples:
            self._sample = gui.add_dropdown("Sample", tuple(samples))
            load = gui.add_button("Take the sample", icon=viser.Icon.FILE, color="gray")
            load.on_click(lambda _: self._post(commands.UseFile(samples[self._sample.value])))

    def _add_live(self, gui: viser.GuiApi) -> None:
        take = gui.add_button(
            "Take the live stream",
            hint="Whoever sends: a webcam, a Kinect's program, a recording that is played",
            icon=viser.Icon.BROADCAST,
            color="gray",
        )
        take.on_click(lambda _: self._post(commands.UseLive()))
        self._live = gui.add_html("")
        self._how = gui.add_html("")


def sample_files() -> dict[str, Path]:
    """Return what ships with the studio, under names that tell what it does."""
    files = sorted(samples_folder().glob("*"))
    shown = {".mcap": "recording", ".jsonl": "skeletons"}
    return {f"{f.stem} ({shown[f.suffix]})": f for f in files if f.suffix in shown}


def described(now: Snapshot) -> str:
    """Return the source in words."""
    source = now.source
    if source is None:
        return markup.block("<b>No source yet.</b> Who teaches?")
    if now.who.puppet is not None:
        return markup.block("Source: <b>you, with the puppet</b>, until Stop")
    if source.is_live:
        return markup.block(f"Source: <b>{markup.text(source.name)}</b>, until Stop")
    hands = "with hand states" if source.has_hand_states else "without hand states: open the gate"
    figures = f"{source.frames} frames, {source.seconds:.1f} s, {hands}"
    return markup.block(f"Source: <b>{markup.text(source.name)}</b><br>{markup.text(figures)}")
