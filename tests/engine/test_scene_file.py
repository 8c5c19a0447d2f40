"""Scenes as files: those that ship, and what is said of one that cannot be used."""

import re
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from studio.engine.errors import FileError
from studio.engine.robot import load_robot
from studio.engine.scene import DEFAULT_SCENE, Scene
from studio.engine.scene_file import read_scene, scene_names, scene_of, table_of
from studio.engine.success import InZone, Lifted

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = sorted((ROOT / "urdf" / "scenes").glob("*.toml"))
(EXAMPLE,) = re.findall(r"```toml\n(.*?)```", (ROOT / "docs" / "scenes.md").read_text(), re.DOTALL)


def test_five_scenes_ship_the_papers_first() -> None:
    assert len(scene_names()) == 5
    assert scene_names()[0] == DEFAULT_SCENE
    assert sorted(scene_names()) == [path.stem for path in SHIPPED]


def test_the_papers_scene_is_the_default_one() -> None:
    assert read_scene(DEFAULT_SCENE) == Scene()


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_name_and_a_path_lead_to_the_same_scene_and_so_does_its_own_table(path: Path) -> None:
    scene = read_scene(path.stem)
    assert scene == read_scene(path) == read_scene(str(path))
    assert scene_of(table_of(scene), "here", path.stem) == scene
    assert scene.name == path.stem


@pytest.mark.parametrize("name", scene_names())
def test_what_has_to_be_lifted_fits_between_the_fingers(name: str) -> None:
    scene = read_scene(name)
    lifted = [c.block for c in scene.success.conditions if isinstance(c, Lifted)]
    assert bool(lifted) == scene.gripper
    widest = 2 * load_robot(fingers=True).limits_of(["left_finger_1"]).upper[0] + 0.015
    assert all(b.size[1] < widest - 0.02 for b in scene.blocks if b.name in lifted)


def test_the_guides_example_is_a_scene(tmp_path: Path) -> None:
    path = tmp_path / "my-scene.toml"
    path.write_text(EXAMPLE)
    scene = read_scene(path)
    assert (scene.name, scene.words) == ("my-scene", "Push the box onto the mat.")
    assert scene.success.conditions == (InZone("box", "mat"),)


def broken(tmp_path: Path, *changes: tuple[str, str]) -> str:
    """Return what is said of the example after some changes."""
    text = EXAMPLE
    for before, after in changes:
        assert before in text
        text = text.replace(before, after, 1)
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(FileError) as refused:
        read_scene(path)
    words = str(refused.value)
    assert words.startswith(f"{path}: ")
    return words.removeprefix(f"{path}: ")


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("mass =", "mas =", "block 1.mass: expected a number.*is 'mas' meant to be it"),
        ("friction = 0.4", "friction = 0.4\ncolor = 1", "block 1.color: there is no such key"),
        ("gripper = false", "griper = false", "griper: there is no such key.*'gripper'"),
        ("mass = 0.3", 'mass = "heavy"', "block 1.mass: expected a number.*'heavy'"),
        ("mass = 0.3", "mass = true", "block 1.mass: expected a number"),
        ("mass = 0.3", "mass = nan", "block 1.mass: expected a number"),
        ("mass = 0.3", "mass = 0.0", "block 1.mass: expected 0.005 to 20 kg.*nearest is 0.005"),
        ("size = [0.14, 0.12, 0.14]", "size = [0.14, 0.12]", "block 1.size: expected 3 numbers"),
        ("size = [0.14, 0.12, 0.14]", "size = [9, 1, 1]", r"block 1.size\[0\]: .*nearest is 3"),
        ("0.28, 0.79]", "0.28, 0.7]", "block 1.position: .*in the desk; the lowest .* is 0.79"),
        ("[0.70, 0.28,", "[1.70, 0.28,", "block 1.position: .*beside the desk"),
        ("center = [0.70, 0.02]", "center = [0.70, -0.25]", "zone 1.center: .*beyond the desk"),
        ('is = "in zone"', 'is = "inzone"', "success 1.is: .*found 'inzone'.*'in zone'"),
        ('zone = "mat"', 'zone = "mad"', "success 1.zone: there is no zone 'mad'.*'mat'"),
        ('block = "box"', 'block = "bx"', "success 1.block: there is no block 'bx'.*'box'"),
        ('zone = "mat"', 'zone = "mat"\narm = "left"', "success 1.arm: only a scene .*both_arms"),
        ('zone = "mat"', 'zone = "mat"\nheight = 0.1', "success 1.height: there is no such key"),
        ("both_arms = false", "both_arms = 0", "both_arms: expected true or false"),
        ('wrist = "zero"', 'wrist = "levl"', "wrist: expected one of zero, level.*'level'"),
        ("[[block]]", "[block]", r"block: expected tables \[\[block\]\]"),
        ("[desk]", "[desks]", r"desk: expected a table \[desk\], found nothing"),
        ('words = "Push', 'words = "" #', "words: expected a text"),
        ("[desk]", "[desk", "expected TOML"),
        ("mass = 0.3", "mass = inf", "block 1.mass: expected a number.*found inf"),
        ("friction = 0.4", "friction = -inf", "block 1.friction: expected a number.*found -inf"),
        ("0.28, 0.79]", "nan, 0.79]", r"block 1.position\[1\]: expected a number.*found nan"),
        (
            "0.28, 0.79]",
            "0.28, 1e300]",
            r"block 1.position\[2\]: expected -3 to 3 m, found 1e\+300",
        ),
        ("0.28, 0.79]", "0.28, 0.82]", "block 1.position: 'box' hangs in the air; .* is at 0.79"),
        ('"mat"', f'"{"m" * 61}"', "zone 1.name: expected 60 characters at most, found 61: short"),
        ('"box"', r'"b\u0000x"', r"block 1.name: .*control characters, found 'b\\x00x': leave"),
        ('"box"', r'"b\nx"', "block 1.name: expected one line that can be printed"),
        ('"box"', r'"b\u202ex"', "block 1.name: expected one line that can be printed"),
        ('words = "P', f'words = "{"P" * 300}', "words: expected 300 characters at most, found 3"),
        ("center = [0.70, 0.02]", "center = [0.7, 0.17]", "success 1.zone: 'box' is in 'mat' from"),
        ("mass = 0.3", f"mass = 1{'0' * 400}", "block 1.mass: expected a number.*found 100"),
        ("mass = 0.3", f"mass = 1{'0' * 5000}", "expected TOML"),
        ("mass = 0.3", f"mass = 0x1{'0' * 5000}", "block 1.mass: .*thousands of digits"),
    ],
)
def test_what_is_wrong_is_named_with_its_place_and_the_nearest_that_is_right(
    tmp_path: Path, before: str, after: str, told: str
) -> None:
    assert re.match(told, broken(tmp_path, (before, after)))


def test_a_byte_order_mark_is_taken_and_a_path_that_is_none_refused(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(EXAMPLE, encoding="utf-8-sig")
    assert read_scene(path).words == "Push the box onto the mat."
    with pytest.raises(FileError, match=r"'x\\x00\.toml': cannot be read"):
        read_scene("x\0.toml")


def test_blocks_stand_beside_each_other_or_on_each_other(tmp_path: Path) -> None:
    block = re.search(r"\[\[block\]\].*?\n\n", EXAMPLE, re.DOTALL)[0]
    other = block.replace('"box"', '"lid"')
    told = broken(tmp_path, (block, block + other))
    assert told.startswith("block 2.position: 'lid' stands in 'box'")
    told = broken(tmp_path, (block, block + block.replace("0.28", "0.50")))
    assert told.startswith("block 2.name: another block is called 'box'")
    stacked = EXAMPLE.replace(block, block + other.replace("0.79]", "0.93]"))
    scene = scene_of(tomllib.loads(stacked), "here", "stacked")
    assert [each.name for each in scene.blocks] == ["box", "lid"]


@pytest.mark.parametrize("given", ["nonsense", "push", "mine.txt"])
def test_a_name_that_nothing_has_is_answered_with_those_that_there_are(given: str) -> None:
    with pytest.raises(FileError, match=r"push-down.*two-in-order.*\.toml"):
        read_scene(given)


def test_files_that_cannot_be_read_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be read"):
        read_scene(tmp_path / "absent.toml")
    (tmp_path / "latin.toml").write_bytes(b'words = "\xe9"')
    with pytest.raises(FileError, match="UTF-8"):
        read_scene(tmp_path / "latin.toml")
    (tmp_path / "large.toml").write_text("#" * 200_000)
    with pytest.raises(FileError, match="scenes up to"):
        read_scene(tmp_path / "large.toml")


def test_a_scene_of_both_arms_names_which_arm(tmp_path: Path) -> None:
    changed = EXAMPLE.replace("both_arms = false", "both_arms = true")
    changed = changed.replace('zone = "mat"', 'zone = "mat"\narm = "right"')
    scene = scene_of(tomllib.loads(changed), "here", "both")
    assert (scene.arms, scene.success.conditions[0].arm) == ("both", "right")
    assert scene_of(table_of(scene), "here", "both") == scene
    assert replace(scene, name="other") != scene


def changed(**changes: object) -> dict[str, object]:
    """Return the example's table with some keys changed."""
    return {**tomllib.loads(EXAMPLE), **changes}


DOWN = {"is": "down", "block": "box"}
IN_MAT = {"is": "in zone", "block": "box", "zone": "mat"}
LIFT = {"is": "lifted", "block": "box", "height": 0.1}


@pytest.mark.parametrize(
    ("both", "conditions", "told"),
    [
        (False, [DOWN, DOWN], "success 2: asks for the same as success 1: keep one of them"),
        (False, [IN_MAT, {**IN_MAT, "released": True}], "success 2: asks for the same"),
        (False, [LIFT, DOWN, {**LIFT, "height": 0.2}], "success 3: asks for the same as success 1"),
        (True, [DOWN, {**DOWN, "arm": "left"}], "success 2: asks for the same"),
        (True, [{**DOWN, "arm": "right"}, {**DOWN, "arm": "left"}], ""),
        (False, [LIFT, DOWN, IN_MAT], ""),
        (False, [IN_MAT, {**IN_MAT, "zone": "rug"}], "success 2.zone: in the end 'box' cannot be"),
        (False, [IN_MAT, {**IN_MAT, "zone": "edge"}], ""),
    ],
)
def test_conditions_are_neither_doubled_nor_contradictory(both, conditions, told: str) -> None:
    zones = [
        {"name": "mat", "center": [0.7, 0.02], "size": [0.2, 0.2]},
        {"name": "rug", "center": [0.9, 0.02], "size": [0.2, 0.2]},
        {"name": "edge", "center": [0.8, 0.02], "size": [0.1, 0.2]},
    ]
    table = changed(success=conditions, zone=zones, both_arms=both)
    if not told:
        assert len(scene_of(table, "here", "mine").success.conditions) == len(conditions)
        return
    with pytest.raises(FileError, match=f"here: {re.escape(told)}"):
        scene_of(table, "here", "mine")


@pytest.mark.parametrize("name", ["a\nb", "a" * 61, "a\0b", ""])
def test_a_scenes_own_name_can_be_shown_in_a_line(name: str) -> None:
    with pytest.raises(FileError, match="a scene's name, its file's, has 1 to 60 characters"):
        scene_of(changed(), f"{name}.toml", name)


def test_a_recordings_scene_may_be_as_people_have_put_it() -> None:
    """A block that was dragged into its zone is no file's mistake, and the recording is read."""
    inside = read_scene("push-into-zone").with_block_at(0.71, 0.01)
    assert scene_of(table_of(inside), "a recording", inside.name) == inside
