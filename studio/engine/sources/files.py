"""Skeletons out of a file, whatever supported format it has."""

import os
from pathlib import Path

from studio.engine.errors import FileError, StudioError
from studio.engine.mcap_log import is_mcap
from studio.engine.sources import mcap_skeletons
from studio.engine.sources.content import Told, open_content, unheard
from studio.engine.sources.family import ParsedFile
from studio.engine.sources.recording import SkeletonRecording, follow
from studio.engine.sources.registry import parse_content


def read_frames(path: str | os.PathLike[str], told: Told = unheard) -> ParsedFile:
    """Return all frames of a file with all their bodies; its content tells its format.

    Parameters
    ----------
    path
        kinect2-socket JSON, node-kinect2 frames, a Kinectron recording, MediaPipe landmarks, an
        NTU RGB+D skeleton, a table of 75, 100, 101 or 175 columns, or the studio's own JSONL, each
        plain or gzip; or skeletons as MCAP.
    told
        Hears on the way what share of the file has been read; of MCAP it hears nothing.

    Raises
    ------
    FileError
        Where the file cannot be read, is of no supported format, is damaged or too large. The
        message names the file, the place, what was expected and what was found.
    """
    if is_mcap(Path(path)):
        return mcap_skeletons.read(Path(path))
    with open_content(path, told) as content:
        return parse_content(content)


def read_skeletons(
    path: str | os.PathLike[str], body: str | None = None, told: Told = unheard
) -> SkeletonRecording:
    """Return the skeletons of one body in a file, whose content tells its format.

    Parameters
    ----------
    path
        A file in any of the formats of `read_frames`.
    body
        The id of the body to take. Without it, the one nearest to the sensor in the floor plane is
        taken and kept; see `studio.engine.sources.following`.
    told
        As in `read_frames`.

    Raises
    ------
    FileError
        As `read_frames` does, or where the file does not show that body.
    """
    name = os.fspath(path)
    parsed = read_frames(path, told)
    try:
        return follow(parsed, name, body)
    except StudioError as error:
        raise FileError(f"{name}: {error}") from None
