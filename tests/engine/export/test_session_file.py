"""A session that was packed opens as it was; one that was tampered with does not open."""

import json
import struct
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

from studio.engine.errors import FileError
from studio.engine.export import Job, Material, session_file
from studio.engine.export.session_reader import is_session, open_session
from studio.engine.teaching import LearnerSettings
from tests.engine.export.materials import done, listed


def packed(material: Material, folder: Path) -> Path:
    (path,) = session_file.write(material, Job(folder))
    return path


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return packed(done("rbf", 50, 2), tmp_path_factory.mktemp("session"))


def rewritten(session: Path, target: Path, change: Callable[[dict[str, bytes]], None]) -> Path:
    """Return a copy of an archive after a change of its files."""
    with ZipFile(session) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    change(files)
    with ZipFile(target, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return target


def changed_manifest(session: Path, target: Path, change: Callable[[dict], None]) -> Path:
    def edit(files: dict[str, bytes]) -> None:
        manifest = json.loads(files["manifest.json"])
        change(manifest)
        files["manifest.json"] = json.dumps(manifest).encode()

    return rewritten(session, target, edit)


@pytest.mark.parametrize("learner", ["rbf", "newrb"])
def test_demonstrations_and_predictions_are_the_same_to_the_bit(
    learner: str, tmp_path: Path
) -> None:
    material = done(learner, 20, 2)
    first, second = material.takes
    left_out = replace(material, takes=(first, replace(second, included=False)))
    found = open_session(packed(left_out, tmp_path))
    for before, after in zip(left_out.takes, found.takes, strict=True):
        old, new = before.demonstration, after.demonstration
        assert (new.name, new.arms, new.mapping, new.first_sample, new.last_sample) == (
            *(old.name, old.arms, old.mapping, old.first_sample, old.last_sample),
        )
        assert new.sent.tobytes() == old.sent.tobytes()
        assert new.times.tobytes() == old.times.tobytes()
        assert after.included == before.included
        assert after.recording.info == before.recording.info
    between = np.linspace(-3.0, 150.0, 500)
    old, new = material.lesson, found.lesson
    assert new.model.predict(between).tobytes() == old.model.predict(between).tobytes()
    assert new.taught.rows.tobytes() == old.taught.rows.tobytes()
    assert new.mse.tobytes() == old.mse.tobytes()
    assert (new.settings, found.setup) == (old.settings, material.setup)
    assert found.learned_from == (0, 1)


def test_the_same_session_gives_the_same_bytes(session: Path, tmp_path: Path) -> None:
    assert packed(done("rbf", 50, 2), tmp_path).read_bytes() == session.read_bytes()


def test_an_opened_session_packs_to_the_same_content(session: Path, tmp_path: Path) -> None:
    with ZipFile(session) as old, ZipFile(packed(open_session(session), tmp_path)) as new:
        assert new.namelist() == old.namelist()
        for name in old.namelist():
            parse = json.loads if name.endswith(".json") else bytes
            assert parse(new.read(name)) == parse(old.read(name))


def test_trims_and_names_come_back(tmp_path: Path) -> None:
    take = listed(1).takes[0]
    whole = take.demonstration
    from studio.engine.export.material import cut  # noqa: PLC0415 - next to what it explains

    trimmed = cut(take.recording, "né à 3 h", whole.first_sample + 7, whole.last_sample - 3)
    material = replace(listed(1), takes=(replace(take, demonstration=trimmed),))
    found = open_session(packed(material, tmp_path))
    assert found.takes[0].demonstration.name == "né à 3 h"
    assert found.takes[0].demonstration.sent.tobytes() == trimmed.sent.tobytes()
    assert found.lesson is None


def test_settings_seed_and_versions_are_told(session: Path) -> None:
    with ZipFile(session) as archive:
        manifest = json.loads(archive.read("manifest.json"))
    assert {"studio", "numpy", "scipy", "pybullet", "mcap"} == set(manifest["versions"])
    assert manifest["settings"]["seed"] == 0
    assert manifest["learned"] == {
        "model": "model.json",
        "learner": "rbf",
        "neurons": 50,
        "from": [0, 1],
    }


def test_a_random_resampling_comes_back_by_its_seed(tmp_path: Path) -> None:
    from studio.engine.teaching import learn  # noqa: PLC0415

    setup = replace(listed(2).setup, interpolation="random", seed=7)
    material = replace(listed(2), setup=setup)
    material = replace(material, lesson=learn(material.taught, LearnerSettings("rbf", 10)))
    found = open_session(packed(material, tmp_path))
    assert found.lesson.taught.rows.tobytes() == material.lesson.taught.rows.tobytes()


def refused(path: Path, words: str) -> None:
    with pytest.raises(FileError, match=words) as caught:
        open_session(path)
    assert str(path) in str(caught.value)


def test_a_lesson_whose_demonstration_was_deleted_is_not_packed(tmp_path: Path) -> None:
    material = done("rbf", 50, 2)
    found = open_session(packed(replace(material, takes=material.takes[:1]), tmp_path))
    assert found.lesson is None
    assert len(found.recordings) == 1


@pytest.mark.parametrize(
    "name",
    ["../evil.py", "/etc/passwd", "recordings/../x.mcap", "recordings/1.mcap", "model.pkl", "a\\b"],
)
def test_files_that_a_session_has_not_are_refused(name: str, session: Path, tmp_path: Path) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    path = rewritten(session, inner / "a.zip", lambda files: files.update({name: b"evil"}))
    refused(path, "does not belong into a session")
    assert [each.name for each in tmp_path.rglob("*")] == ["inner", "a.zip"]


def test_a_file_that_is_there_twice_is_refused(session: Path, tmp_path: Path) -> None:
    path = tmp_path / "a.zip"
    path.write_bytes(session.read_bytes())
    with pytest.warns(UserWarning, match="Duplicate"), ZipFile(path, "a") as archive:
        archive.writestr("manifest.json", b"{}")
    refused(path, "twice")


def test_what_unpacks_to_too_much_is_refused_before_it_is_unpacked(
    session: Path, tmp_path: Path
) -> None:
    path = tmp_path / "bomb.zip"
    with ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr("manifest.json", b" " * (5 << 20))
    refused(path, "manifest.json unpacks to 5,242,880 bytes; up to")


def test_a_size_that_is_a_lie_does_not_unpack_more(session: Path, tmp_path: Path) -> None:
    path = tmp_path / "lie.zip"
    with ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("manifest.json", b" " * (8 << 20))
    content = path.read_bytes().replace(struct.pack("<L", 8 << 20), struct.pack("<L", 100))
    path.write_bytes(content)
    refused(path, "CRC|not a whole archive")


def test_a_table_of_contents_too_large_is_not_read(session: Path, tmp_path: Path) -> None:
    path = tmp_path / "many.zip"
    with ZipFile(path, "w") as archive:
        for number in range(700):
            archive.writestr(f"recordings/{number:03d}.mcap", b"")
    refused(path, "a table of 700 files")
    content = bytearray(session.read_bytes())
    content[-10:-6] = struct.pack("<L", 1 << 30)  # what the end says of the table's size
    lying = tmp_path / "lying.zip"
    lying.write_bytes(bytes(content))
    refused(lying, "1,073,741,824 bytes")


@pytest.mark.parametrize("packing", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_other_packings_are_refused(packing: int, tmp_path: Path) -> None:
    path = tmp_path / "a.zip"
    with ZipFile(path, "w", packing) as archive:
        archive.writestr("manifest.json", b"{}")
    refused(path, "packed in a way")


@pytest.mark.parametrize("kept", [0, 3, 30, 5000, -40, -1])
def test_an_archive_that_was_cut_off_is_refused(kept: int, session: Path, tmp_path: Path) -> None:
    path = tmp_path / "cut.zip"
    path.write_bytes(session.read_bytes()[:kept])
    refused(path, "archive")


def test_a_damaged_byte_is_noticed(session: Path, tmp_path: Path) -> None:
    """Wherever it is: what opens all the same is what was packed."""
    content = session.read_bytes()
    expected = open_session(session)
    rng = np.random.default_rng(0)
    for place in rng.integers(0, len(content), 12):
        damaged = bytearray(content)
        damaged[place] ^= 0x10
        path = tmp_path / "damaged.zip"
        path.write_bytes(bytes(damaged))
        try:
            found = open_session(path)
        except FileError:
            continue
        assert found.lesson.curve.tobytes() == expected.lesson.curve.tobytes()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda m: m.update(schema=2), "schema: expected 1, found 2; a newer studio"),
        (lambda m: m.update(format="x"), "format"),
        (lambda m: m.update(recordings=["../a.mcap"]), "recordings: expected"),
        (lambda m: m.update(recordings=[]), r"demonstrations\[0\]: recording"),
        (lambda m: m["demonstrations"][1].update(first=9**9), r"demonstrations\[1\]|samples"),
        (lambda m: m["demonstrations"][1].update(last=10**6), "samples"),
        (lambda m: m["demonstrations"][0].update(name="a\nb"), "a name in a line"),
        (lambda m: m["demonstrations"][0].update(included=1), "true or false"),
        (lambda m: m["settings"].update(arms="tail"), "arms: expected one of left, right, both"),
        (lambda m: m["settings"].update(neurons=-1), "neurons"),
        (lambda m: m["settings"].update(neurons=10**6), "neurons"),
        (lambda m: m.pop("settings"), "settings"),
        (lambda m: m["learned"].update({"from": [0, 5]}), "numbers of demonstrations"),
        (lambda m: m["learned"].update(model="other.json"), "model"),
        (lambda m: m["learned"].update(learner="newrb"), "the network of newrb"),
        (lambda m: m.update(demonstrations={}), "as a list"),
    ],
)
def test_a_manifest_that_cannot_be_is_refused(
    change: Callable[[dict], None], words: str, session: Path, tmp_path: Path
) -> None:
    refused(changed_manifest(session, tmp_path / "a.zip", change), words)


@pytest.mark.parametrize("content", [b"", b"[", b"[]", b"\xff", b"[" * 100_000, b"null"])
@pytest.mark.parametrize("name", ["manifest.json", "model.json", "recordings/001.mcap"])
def test_content_that_is_something_else_is_refused(
    name: str, content: bytes, session: Path, tmp_path: Path
) -> None:
    path = rewritten(session, tmp_path / "a.zip", lambda files: files.update({name: content}))
    refused(path, name.replace(".", r"\."))
    missing = rewritten(session, tmp_path / "b.zip", lambda files: files.pop(name) and None)
    refused(missing, "is missing")


def test_archives_are_told_by_content(session: Path, tmp_path: Path) -> None:
    assert is_session(session)
    assert not is_session(tmp_path / "none.zip")
    (tmp_path / "text.zip").write_text("no")
    assert not is_session(tmp_path / "text.zip")
    refused(tmp_path / "text.zip", "not an archive")
    refused(tmp_path / "none.zip", "cannot be read")
