"""Where skeletons come from. One module a family of formats, told apart by content."""

from studio.engine.sources.files import read_frames, read_skeletons
from studio.engine.sources.jsonl import (
    frame_from_json,
    frame_to_json,
    skeleton_from_dict,
    skeleton_to_dict,
    write_skeletons,
)
from studio.engine.sources.recording import SkeletonRecording

__all__ = [
    "SkeletonRecording",
    "frame_from_json",
    "frame_to_json",
    "read_frames",
    "read_skeletons",
    "skeleton_from_dict",
    "skeleton_to_dict",
    "write_skeletons",
]
