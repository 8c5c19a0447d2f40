"""1 Source: who teaches (a sample, a file, the demonstrator), with which arm, how mapped."""

from pathlib import Path

import viser

from studio.engine import commands
from studio.engine.errors import FileError
from studio.engine.gate import GateMode
from studio.engine.resources import samples_folder
from studio.engine.retarget import Mapping
from studio.engine.skeleton import SIDES
from studio.engine.snapshot import Snapshot, SourceStatus
from studio.panels import markup
from studio.panels.inputs import Post, on_choice, show_value
from studio.panels.readiness import why_not_configure
from studio.panels.uploads import Uploads, shown_name

MAPPINGS: dict[Mapping, str] = {"exact": "exact: s0, s1, e0, e1", "paper": "paper: s0, s1, e1"}
GATES: dict[GateMode, str] = {"sequence": "Lasso, Open, Closed", "open": "open, no signs"}
_MAPPING_NOTES: dict[Mapping, str] = {
    "exact": "Baxter's upper arm and forearm point where the person's do.",
    "paper": "e0 stays 0, so the forearm swings in one plane only: its direction is 48° off in the "
    "median of real recordings.",
}


class SourcePanel:
    """The first step."""

    def __init__(self, gui: viser.GuiApi, post: Post, uploads: Uploads) -> None:
        self._post, self._uploads = post, uploads
        self._drawn: object = None
        self._now = gui.add_html("")
        self._add_sources(gui)
        self._problem = gui.add_html("", visible=False)
        gui.add_divider()
        self._side = gui.add_dropdown("Arm", SIDES)
        self._mapping = gui.add_dropdown("Mapping", tuple(MAPPINGS.values()))
        self._gate = gui.add_dropdown("Gate", tuple(GATES.values()))
        self._settings = (self._side, self._mapping, self._gate)
        for control in self._settings:
            on_choice(control, self._configure)
        self._notes = gui.add_html("")

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._now.content = described(now.source)
        # Only what has changed, or has been refused: a choice just made is on its way.
        settings = (now.side, now.mapping, now.gate_mode, now.message.number)
        if settings != self._drawn:
            self._drawn = settings
            show_value(self._side, now.side)
            show_value(self._mapping, MAPPINGS[now.mapping])
            show_value(self._gate, GATES[now.gate_mode])
        refusal = why_not_configure(now)
        for control in self._settings:
            control.disabled = bool(refusal)
        self._notes.content = markup.reasons([refusal]) + markup.note(_MAPPING_NOTES[now.mapping])

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
            hint="Skeletons (JSONL, kinect2-socket JSON, tables) or a recording (MCAP)",
            icon=viser.Icon.UPLOAD,
        )
        upload.on_upload(self._receive)

    def _receive(self, event: viser.GuiEvent[viser.GuiUploadButtonHandle]) -> None:
        file = event.target.value
        try:
            path = self._uploads.keep(file.name, file.content)
        except FileError as error:
            self._problem.content, self._problem.visible = markup.problem(str(error)), True
        else:
            self._problem.visible = False
            self._post(commands.UseFile(path, shown_name(file.name)))

    def _configure(self) -> None:
        self._post(
            commands.Configure(
                self._side.value,
                next(key for key, label in MAPPINGS.items() if label == self._mapping.value),
                next(key for key, label in GATES.items() if label == self._gate.value),
            )
        )


def sample_files() -> dict[str, Path]:
    """Return what ships with the studio, under names that tell what it does."""
    files = sorted(samples_folder().glob("*"))
    shown = {".mcap": "recording", ".jsonl": "skeletons"}
    return {f"{f.stem} ({shown[f.suffix]})": f for f in files if f.suffix in shown}


def described(source: SourceStatus | None) -> str:
    """Return the source in words."""
    if source is None:
        return markup.block("<b>No source yet.</b> Who teaches?")
    hands = "with hand states" if source.has_hand_states else "without hand states: open the gate"
    figures = f"{source.frames} frames, {source.seconds:.1f} s, {hands}"
    return markup.block(f"Source: <b>{markup.text(source.name)}</b><br>{markup.text(figures)}")
