"""A real Chromium. Where there is none these tests skip; in CI, that is a failure."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Error, Page, sync_playwright

from tests.panels.conftest import mesh_folder  # noqa: F401 - not the user's own cache

NAMES = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",  # WebGL without a graphics card
    "--enable-unsafe-swiftshader",
    "--disable-gpu-compositing",  # all but the 3D view is drawn in a third of the time without
    "--disable-background-networking",
)
# The 3D view is drawn a few times a second instead of as often as the machine can.
FEWER_PICTURES = """
const next = window.requestAnimationFrame.bind(window);
const canceled = new Set();
window.requestAnimationFrame = (draw) => {
  const number = setTimeout(() => next((now) => canceled.delete(number) || draw(now)), 100);
  return number;
};
window.cancelAnimationFrame = (number) => {
  clearTimeout(number);
  canceled.add(number);
};
"""
PATIENCE = 90_000  # [ms] for anything: a machine without a graphics card draws a picture a second


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        program = next(filter(None, map(shutil.which, NAMES)), playwright.chromium.executable_path)
        if not Path(program).is_file():
            without_browser("no Chromium: install the chromium package, or: playwright install")
        try:
            started = playwright.chromium.launch(executable_path=program, args=FLAGS)
        except Error as error:
            without_browser(f"Chromium does not start: {error}")
        yield started
        started.close()


def without_browser(why: str) -> None:
    if os.environ.get("CI"):
        pytest.fail(why)
    pytest.skip(why)


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """A page whose errors, if any, fail the test."""
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    context.set_default_timeout(PATIENCE)
    context.add_init_script(FEWER_PICTURES)
    opened = context.new_page()
    errors: list[str] = []
    opened.on("pageerror", lambda error: errors.append(str(error)))
    yield opened
    context.close()
    assert errors == []
