"""All numbers as one NPZ file of plain arrays, for `numpy.load` as it comes: nothing is pickled."""

import io
from pathlib import Path
from zipfile import ZipFile

import numpy as np
from numpy.typing import NDArray

from studio.engine.export.files import pack
from studio.engine.export.kind import Job
from studio.engine.export.material import Material
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES
from studio.engine.sources.whole_file import written_whole
from studio.engine.teaching import INDEX_TIME

FILE = "data.npz"


def write(material: Material, job: Job) -> tuple[Path, ...]:
    """Write the arrays."""
    path = job.folder / FILE
    with written_whole(path) as unfinished, ZipFile(unfinished, "w") as archive:
        for name, array in arrays_of(material).items():
            content = io.BytesIO()
            np.lib.format.write_array(content, np.ascontiguousarray(array), allow_pickle=False)
            pack(archive, f"{name}.npy", content.getvalue())
    job.done(1.0)
    return (path,)


def arrays_of(material: Material) -> dict[str, NDArray[np.generic]]:
    """Return the arrays by name; angles in rad, times in s, lengths in m.

    ``sent_1``, ``times_1`` and so on are the demonstrations as they were sent, before resampling.
    """
    taught = material.taught
    found: dict[str, NDArray[np.generic]] = {
        "names": np.array([each.name for each in taught.demonstrations]),
        "joints": np.array(taught.joints),
        "index": INDEX_TIME,
        "durations": np.array([each.duration for each in taught.demonstrations]),
        "demonstrations": taught.rows,  # (K, 142, D)
        "mean": taught.mean,  # (142, D)
    }
    for number, each in enumerate(taught.demonstrations, start=1):
        found |= {f"times_{number}": each.times, f"sent_{number}": each.sent}
    if material.lesson is not None:
        found |= {"network": material.lesson.curve, "mse": material.lesson.mse}
        if material.lesson.floor is not None:
            found["floor"] = material.lesson.floor
    if material.reproduction is not None:
        alone = material.reproduction.performance
        states = [tick.world for tick in alone.ticks]
        found |= {
            "all_joints": np.array(JOINT_NAMES),
            "reproduction_times": CONTROL_PERIOD * np.arange(len(states) + 1),
            "reproduction": np.vstack([alone.start, *(s.joint_positions for s in states)]),
            "reproduction_sent": np.array([tick.command.sent for tick in alone.ticks]),
            "reproduction_blocks": np.array([state.block_poses for state in states]),
        }
    return found
