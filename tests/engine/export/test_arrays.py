from pathlib import Path
from zipfile import ZipFile

import numpy as np

from studio.engine.export import Job, arrays
from tests.engine.export.materials import done, listed


def test_arrays_are_read_without_pickles_and_are_the_same(tmp_path: Path) -> None:
    material = done()
    (path,) = arrays.write(material, Job(tmp_path))
    with np.load(path, allow_pickle=False) as held:
        assert held["joints"].tolist() == list(material.taught.joints)
        assert held["demonstrations"].tobytes() == material.taught.rows.tobytes()
        assert held["network"].tobytes() == material.lesson.curve.tobytes()
        for number, take in enumerate(material.takes, start=1):
            assert held[f"sent_{number}"].tobytes() == take.demonstration.sent.tobytes()
        alone = material.reproduction.performance
        last = alone.ticks[-1].world
        np.testing.assert_array_equal(held["reproduction"][-1], last.joint_positions)
        assert len(held["reproduction"]) == len(held["reproduction_times"])
        assert set(held) == set(arrays.arrays_of(material))


def test_the_same_material_gives_the_same_bytes(tmp_path: Path) -> None:
    written = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (path,) = arrays.write(listed(), Job(tmp_path / name))
        written.append(path.read_bytes())
    assert written[0] == written[1]
    with ZipFile(path) as archive:
        assert {entry.date_time[0] for entry in archive.infolist()} == {1980}
