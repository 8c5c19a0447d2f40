"""The report of a sweep over numbers of neurons, as one page that needs no network."""

from pathlib import Path

from studio.engine.export.files import write_text
from studio.engine.export.kind import Job
from studio.engine.export.material import Material
from studio.engine.sweep import DEFAULT_LEARNERS, sweep
from studio.engine.sweep_page import sweep_page

FILE = "report.html"


def write(material: Material, job: Job) -> tuple[Path, ...]:
    """Measure the paper's numbers of neurons on what was taught, and write the page."""
    path = job.folder / FILE
    job.done(0.0)
    table = sweep(material.taught, job.timer, DEFAULT_LEARNERS, jobs=1)
    job.done(0.9)
    write_text(path, sweep_page(table))
    job.done(1.0)
    return (path,)
