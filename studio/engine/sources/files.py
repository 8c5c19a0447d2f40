"""Skeletons out of a file, whatever supported format it has."""

import os

from studio.engine.errors import FileError, StudioError
from studio.engine.sources.content import read_content
from studio.engine.sources.recording import SkeletonRecording, follow
from studio.engine.sources.registry import parse


def read_skeletons(path: str | os.PathLike[str], body: str | None = None) -> SkeletonRecording:
    """Return the skeletons of one body in a file, whose content tells its format.

    Parameters
    ----------
    path
        kinect2-socket JSON, a table of 75, 100, 101 or 175 columns, or the studio's own JSONL;
        plain or gzip.
    body
        The id of the body to take. Without it, the body followed so far is kept while it is seen;
        otherwise the one nearest to the sensor in the floor plane is taken.

    Raises
    ------
    FileError
        Where the file cannot be read, is of no supported format or is damaged, or does not show
        that body. The message names the file, the place, what was expected and what was found.
    """
    name = os.fspath(path)
    parsed = parse(name, read_content(path))
    try:
        return follow(parsed, name, body)
    except StudioError as error:
        raise FileError(f"{name}: {error}") from None
