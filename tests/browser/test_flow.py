"""The whole flow, as a newcomer goes through it: source, teach, learn, compare, export, reopen."""

import csv
import io
import zipfile
from pathlib import Path

import cv2
import numpy as np
from playwright.sync_api import Page, expect

from studio.engine import commands
from studio.engine.export import KINDS
from studio.engine.mcap_file import read_recording
from studio.panels.delivery import ARCHIVE
from studio.rbf import load_model
from tests.browser.conftest import PATIENCE
from tests.browser.opened import Studio, studio_on

FAST = 8.0  # times real time
LAPTOP, PROJECTOR = (1366, 768), (1024, 768)
EVERYTHING = {  # and the kind that each box stands for
    "Replay page": "replay",
    "Tables (CSV)": "csv",
    "Arrays (NPZ)": "npz",
    "Recordings (MCAP)": "mcap",
    "Network (JSON)": "model",
    "Video": "video",
    "Report (HTML)": "html",
}
WITHOUT_WAITING = tuple(EVERYTHING)[:-2]  # a film and a report take longer than all the others


def light_or_dark(studio: Studio, is_dark: bool) -> None:
    if is_dark:
        studio.command("Dark or light")
    scheme = "dark" if is_dark else "light"
    expect(studio.page.locator("html")).to_have_attribute("data-mantine-color-scheme", scheme)


def nothing_is_cut_off(page: Page) -> None:
    """No panel has more to show sideways than its width."""
    wider = page.evaluate(
        "() => [...document.querySelectorAll('[data-dock-leaf] .mantine-ScrollArea-viewport')]"
        ".filter(e => e.scrollWidth > e.clientWidth + 2).length"
    )
    assert wider == 0


def gate_and_state_are_read_from_afar(page: Page) -> None:
    for word in ("LASSO", "OPEN", "CLOSED", "IDLE", "Nobody is watched"):
        shown = page.get_by_text(word).locator("visible=true").first
        assert shown.evaluate("e => parseFloat(getComputedStyle(e).fontSize)") >= 24.0, word


def walk(studio: Studio) -> None:
    """Go from nothing to a motion that was reproduced."""
    expect(studio.page.locator("canvas").first).to_be_visible()
    gate_and_state_are_read_from_afar(studio.page)
    studio.open_step("4 Compare")
    expect(studio.button("Let Baxter do it alone")).to_be_disabled()
    studio.shows("Nothing is learned yet")
    studio.open_step("5 Export")
    expect(studio.button("Export")).to_be_disabled()
    studio.shows("record one in 2 Teach")
    studio.teach_once("demonstration-001")
    studio.teach_once("demonstration-002")
    for entry in studio.now.entries:  # a second of each, so that the film is soon done
        studio.loop.session.post(commands.Trim(entry.number, 2.0, 3.0))
    studio.waits(lambda now: all(entry.is_trimmed for entry in now.entries))
    studio.open_step("3 Learn")
    studio.press("Train")
    studio.shows("Learned with 50 neurons")
    nothing_is_cut_off(studio.page)
    studio.open_step("4 Compare")
    studio.press("Let Baxter do it alone")
    studio.waits(lambda now: now.reproduction is not None)
    studio.shows("against the mean demonstration")
    nothing_is_cut_off(studio.page)


def test_all_of_it_on_a_laptop_and_every_export_opens_again(page: Page, tmp_path: Path) -> None:
    page.set_viewport_size(dict(zip(("width", "height"), LAPTOP, strict=True)))
    with studio_on(page, tmp_path / "recordings", FAST) as studio:
        light_or_dark(studio, is_dark=False)
        walk(studio)
        export(studio, tmp_path, tuple(EVERYTHING))
    reopen(page, tmp_path / "files", tuple(EVERYTHING))


def test_all_of_it_on_a_projector_in_the_dark(page: Page, tmp_path: Path) -> None:
    page.set_viewport_size(dict(zip(("width", "height"), PROJECTOR, strict=True)))
    with studio_on(page, tmp_path / "recordings", FAST) as studio:
        light_or_dark(studio, is_dark=True)
        walk(studio)
        export(studio, tmp_path, WITHOUT_WAITING)
        boxes = [page.locator("[data-floating-window]").first.bounding_box()]
        evidence = page.locator("[data-dock-region=right]").bounding_box()
        assert all(box["x"] + box["width"] <= evidence["x"] for box in boxes)
    reopen(page, tmp_path / "files", WITHOUT_WAITING)


def export(studio: Studio, folder: Path, labels: tuple[str, ...]) -> None:
    """Export these kinds and the session, which is opened again; the others lie in ``files``."""
    studio.open_step("5 Export")
    for label in labels:
        studio.tick(label)
    files: dict[str, Path] = {}
    studio.page.on(
        "download", lambda download: files.update({download.suggested_filename: download})
    )
    studio.press("Export")
    # A film of two seconds takes eight, on a machine that does nothing else.
    studio.waits(lambda now: now.export.number == 1 or now.message.is_error, 4 * PATIENCE)
    studio.waits(lambda _: len(files) == 2)
    for name, download in files.items():
        download.save_as(folder / name)
    assert files.keys() == {"session.zip", ARCHIVE}
    reopen_the_session(studio, folder / "session.zip")
    with zipfile.ZipFile(folder / ARCHIVE) as archive:
        archive.extractall(folder / "files")


def reopen_the_session(studio: Studio, path: Path) -> None:
    before = studio.now
    studio.upload("Open a session (.zip)", path)
    studio.shows("Opened session.zip: 2 demonstrations, and what was learned from them.")
    now = studio.now
    assert len(now.entries) == 2 * len(before.entries)
    ours, theirs = before.entries[0].demonstration, now.entries[2].demonstration
    assert np.array_equal(ours.sent, theirs.sent)
    assert now.lesson is not before.lesson
    assert now.lesson.settings == before.lesson.settings


def reopen(page: Page, folder: Path, labels: tuple[str, ...]) -> None:
    """Open every file that was exported with what it is for."""
    names = {path.name for path in folder.iterdir()}
    kinds = [KINDS[EVERYTHING[label]] for label in labels if EVERYTHING[label] in KINDS]
    assert len(kinds) == len(labels) - 1  # all but the replay page, which the panels make
    for pattern in (pattern for kind in kinds for pattern in kind.files):
        assert any(Path(name).match(pattern) for name in names)
    for path in folder.glob("*.csv"):
        rows = list(csv.reader(io.StringIO(path.read_text())))
        assert len(rows) > 1
        assert len({len(row) for row in rows}) == 1
    with np.load(folder / "data.npz", allow_pickle=False) as arrays:
        assert all(
            np.isfinite(arrays[name]).all() for name in arrays if arrays[name].dtype.kind == "f"
        )
    for path in folder.glob("*.mcap"):
        assert read_recording(path).warning == ""
    assert load_model(folder / "model.json")
    page.context.set_offline(True)
    if "Video" in labels:
        film = cv2.VideoCapture(str(next(folder.glob("*.webm"))))
        assert film.read()[0]
    if "Report (HTML)" in labels:
        page.goto((folder / "report.html").as_uri())
        expect(page.locator("h1").first).to_be_visible()
    page.goto((folder / "replay.html").as_uri())
    expect(page).to_have_title("Baxter does it alone")
    expect(page.locator("canvas").first).to_be_visible()
