"""All kinds of export that need no browser, and one way to ask for them."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from studio.engine.errors import FileError, StudioError
from studio.engine.export import (
    arrays,
    model,
    recordings,
    report_page,
    session_file,
    tables,
    video,
)
from studio.engine.export.anonymous import anonymous as without_names
from studio.engine.export.files import ready_folder
from studio.engine.export.kind import Job, Kind, lacks_nothing, lacks_reproduction
from studio.engine.export.material import Material

_ALL = (
    Kind(
        "csv",
        "tables for a spreadsheet: demonstrations, network, reproduction",
        tuple(tables.FILES),
        lacks_nothing,
        tables.write,
    ),
    Kind("npz", "all arrays for NumPy", (arrays.FILE,), lacks_nothing, arrays.write),
    Kind(
        "mcap",
        "the recordings, for Foxglove or for another studio",
        ("recording-*.mcap",),
        lacks_nothing,
        recordings.write,
    ),
    Kind("model", "the network, as JSON", (model.FILE,), model.lacks, model.write),
    Kind(
        "html",
        "a report on numbers of neurons, one page",
        (report_page.FILE,),
        lacks_nothing,
        report_page.write,
    ),
    Kind(
        "video",
        "a film: a demonstration beside what Baxter does alone",
        (video.FILE,),
        lacks_reproduction,
        video.write,
    ),
    Kind(
        "zip",
        "the whole session, which opens again",
        (session_file.FILE,),
        lacks_nothing,
        session_file.write,
    ),
)
KINDS: dict[str, Kind] = {kind.name: kind for kind in _ALL}


def export(
    material: Material,
    names: Sequence[str],
    job: Job,
    anonymous: bool = False,
    kinds: Mapping[str, Kind] = KINDS,
) -> tuple[Path, ...]:
    """Write some kinds of files into the job's folder, and return the files.

    Parameters
    ----------
    material : Material
    names : kinds, by their names
    job : where to, and whom to tell how far it is
    anonymous : whether names of files, sources, demonstrations and bodies are left out
    kinds : those that there are; the panels add one

    Raises
    ------
    StudioError
        Where there is no such kind, or what it needs is missing; then nothing is written.
    FileError
        Where a file cannot be written.
    StoppedError
        Where the job was stopped; the file that was being written is not there then.
    """
    chosen = [_kind_of(name, kinds) for name in dict.fromkeys(names)]
    if not material.takes:
        raise StudioError("There is nothing to export: record a demonstration first")
    for kind in chosen:
        missing = kind.lacks(material)
        if missing:
            raise StudioError(f"{kind.name}: {missing}")
    ready_folder(job.folder)
    shown = without_names(material) if anonymous else material
    written: list[Path] = []
    for place, kind in enumerate(chosen):
        part = job.part(place / len(chosen), (place + 1) / len(chosen))
        try:
            written += kind.write(shown, part)
        except OSError as error:
            raise FileError(f"{job.folder}: cannot write {kind.name}: {error.strerror}") from error
    return tuple(written)


def _kind_of(name: str, kinds: Mapping[str, Kind]) -> Kind:
    if name not in kinds:
        raise StudioError(f"there is no export {name!r}; there are {', '.join(kinds)}")
    return kinds[name]
