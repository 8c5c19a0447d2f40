"""The whole session as one archive that opens again: `write` here, `open_session` beside it."""

import json
import tempfile
from pathlib import Path
from zipfile import ZipFile

from studio.engine.export.files import pack
from studio.engine.export.kind import Job
from studio.engine.export.manifest import MANIFEST, MODEL, manifest_of, recording_name
from studio.engine.export.material import Material
from studio.engine.export.model import write_model
from studio.engine.mcap_file import write_recording
from studio.engine.sources.whole_file import written_whole

FILE = "session.zip"


def write(material: Material, job: Job) -> tuple[Path, ...]:
    """Write the session: the same material gives the same bytes."""
    path = job.folder / FILE
    manifest = manifest_of(material)
    count = len(material.recordings)
    with (
        tempfile.TemporaryDirectory() as scratch,
        written_whole(path) as unfinished,
        ZipFile(unfinished, "w") as archive,
    ):
        pack(archive, MANIFEST, json.dumps(manifest, indent=1, allow_nan=False).encode())
        if manifest["learned"] is not None and material.lesson is not None:
            write_model(Path(scratch, MODEL), material.lesson)
            pack(archive, MODEL, Path(scratch, MODEL).read_bytes())
        for index, recording in enumerate(material.recordings):
            file = Path(scratch, f"{index}.mcap")
            write_recording(file, recording)
            # Its chunks are packed already.
            pack(archive, recording_name(index), file.read_bytes(), packed=False)
            file.unlink()
            job.done((index + 1) / count)
    return (path,)
