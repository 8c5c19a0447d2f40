"""Scenes as TOML files: those that ship (urdf/scenes), and users' own. See docs/scenes.md."""

import tomllib
from collections.abc import Callable, Iterable
from functools import cache
from itertools import chain
from pathlib import Path
from typing import Any, TypeVar

from studio.engine.errors import FileError, StudioError
from studio.engine.resources import resource_root
from studio.engine.scene import DEFAULT_SCENE, Scene
from studio.engine.scene_check import Problem, impossible, misplaced, unready
from studio.engine.scene_parts import Block, Desk, Pair, Triple, Zone
from studio.engine.skeleton import SIDES, Side
from studio.engine.success import Condition, Down, InZone, Lifted, Success
from studio.engine.toml_table import Range, Table
from studio.engine.wrist import WRIST_MODES

SUFFIX = ".toml"
LARGEST_FILE = 100_000  # bytes
LONGEST_NAME, LONGEST_WORDS = 60, 300  # characters
MOST_BLOCKS, MOST_ZONES, MOST_CONDITIONS = 20, 10, 20
SIDE = Range(0.01, 3.0, "m")
PLACE = Range(-3.0, 3.0, "m")
MASS = Range(0.005, 20.0, "kg")
FRICTION = Range(0.0, 2.0)
HEIGHT = Range(0.01, 0.5, "m")
_Named = TypeVar("_Named", Block, Zone)


def scene_names() -> tuple[str, ...]:
    """Return the names of the scenes that ship, the default one first."""
    found = sorted(path.stem for path in _folder().glob(f"*{SUFFIX}"))
    return tuple(sorted(found, key=lambda name: name != DEFAULT_SCENE))


def read_scene(path_or_name: str | Path) -> Scene:
    """Return a scene that ships, by its name, or one of a user's, by its path.

    It is told for the left arm, or for both where it takes both: see `Scene.taught_by`.

    Raises
    ------
    FileError
        Where there is none, or the file is no scene; it names the place and the cure.
    """
    given = str(path_or_name)
    if given in scene_names():
        return _shipped(given)
    path = Path(path_or_name)
    if path.suffix != SUFFIX:
        raise FileError(
            f"there is no scene {given!r}: name one of {', '.join(scene_names())}, or the path of "
            f"a file of your own that ends in {SUFFIX}"
        )
    return _read(path)


def scene_of(table: dict[str, Any], file: str, name: str) -> Scene:
    """Return the scene that a table of TOML (or of JSON) tells; see `read_scene` for the errors.

    A recording's scene, too, in which people may have put blocks wherever there is room: whether
    the task can begin like that is asked of files only.
    """
    if not name.isprintable() or not 0 < len(name) <= LONGEST_NAME:
        raise FileError(
            f"{file!r:.200}: a scene's name, its file's, has 1 to {LONGEST_NAME} characters that "
            "can be printed: rename it"
        )
    top = Table(file, "", table)
    both, gripper = top.flag("both_arms", False), top.flag("gripper", False)
    words, in_order = top.text("words", LONGEST_WORDS), top.flag("in_order", False)
    wrist = next(mode for mode in WRIST_MODES if mode == top.one_of("wrist", WRIST_MODES, "zero"))
    desk = _desk(top.table("desk"))
    blocks = _named(top, "block", _block, MOST_BLOCKS, needed=True)
    zones = _named(top, "zone", _zone, MOST_ZONES, needed=False)
    listed = _few(top, "success", MOST_CONDITIONS, needed=True)
    conditions = tuple(_condition(each, blocks, zones, both) for each in listed)
    top.end()
    try:
        scene = Scene(
            desk,
            blocks,
            "both" if both else "left",
            name,
            zones,
            Success(conditions, in_order),
            both,
            gripper,
            words,
            wrist,
        )
    except StudioError as error:
        raise FileError(f"{file}: {error}") from error
    _refuse(file, chain(misplaced(scene), impossible(scene)))
    return scene


def table_of(scene: Scene) -> dict[str, Any]:
    """Return the table that `scene_of` reads as this scene, its arms aside."""
    desk = scene.desk
    return {
        "words": scene.words,
        "both_arms": scene.both_arms,
        "gripper": scene.gripper,
        "wrist": scene.wrist,
        "in_order": scene.success.in_order,
        "desk": {
            "size": list(desk.size),
            "position": list(desk.position),
            "friction": desk.friction,
        },
        "block": [
            {
                "name": block.name,
                "size": list(block.size),
                "position": list(block.position),
                "mass": block.mass,
                "friction": block.friction,
            }
            for block in scene.blocks
        ],
        "zone": [
            {"name": zone.name, "center": list(zone.center), "size": list(zone.size)}
            for zone in scene.zones
        ],
        "success": [_told(condition) for condition in scene.success.conditions],
    }


def _folder() -> Path:
    return resource_root() / "urdf" / "scenes"


@cache
def _shipped(name: str) -> Scene:
    return _read(_folder() / f"{name}{SUFFIX}")


def _read(path: Path) -> Scene:
    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise FileError(f"{path}: {size:,} bytes; scenes up to {LARGEST_FILE:,} are read")
        text = path.read_text(encoding="utf-8-sig")  # some editors put a mark in front
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise FileError(f"{path}: expected text in UTF-8; save it as that") from error
    except ValueError as error:  # a NUL in the path
        raise FileError(f"{str(path)!r}: cannot be read: {error}") from error
    try:
        table = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # also of whole numbers with too many digits
        raise FileError(f"{path}: expected TOML (docs/scenes.md): {error}") from error
    scene = scene_of(table, str(path), path.stem)
    _refuse(str(path), unready(scene))
    return scene


def _refuse(file: str, problems: Iterable[Problem]) -> None:
    for problem in problems:
        raise FileError(f"{file}: {problem.place}: {problem.words}")


def _desk(table: Table) -> Desk:
    desk = Desk(
        _triple(table, "size", SIDE),
        _triple(table, "position", PLACE),
        table.number("friction", FRICTION),
    )
    table.end()
    return desk


def _block(table: Table) -> Block:
    return Block(
        _triple(table, "size", SIDE),
        _triple(table, "position", PLACE),
        table.number("mass", MASS),
        table.number("friction", FRICTION),
        table.text("name", LONGEST_NAME),
    )


def _zone(table: Table) -> Zone:
    name = table.text("name", LONGEST_NAME)
    return Zone(name, _pair(table, "center", PLACE), _pair(table, "size", SIDE))


def _condition(
    table: Table, blocks: Iterable[Block], zones: Iterable[Zone], both: bool
) -> Condition:
    kind = table.one_of("is", ("down", "in zone", "lifted"))
    block = _known(table, "block", [each.name for each in blocks])
    arm = _arm(table, both)
    found: Condition
    match kind:
        case "down":
            found = Down(block, arm)
        case "lifted":
            found = Lifted(block, table.number("height", HEIGHT), arm)
        case _:
            zone = _known(table, "zone", [each.name for each in zones])
            found = InZone(block, zone, arm, table.flag("released", False))
    table.end()
    return found


def _told(condition: Condition) -> dict[str, Any]:
    """Return the table that `_condition` reads as this one."""
    arm = {} if condition.arm is None else {"arm": condition.arm}
    match condition:
        case Down(block=block):
            return {"is": "down", "block": block} | arm
        case Lifted(block=block, height=height):
            return {"is": "lifted", "block": block, "height": height} | arm
        case InZone(block=block, zone=zone, released=released):
            return {"is": "in zone", "block": block, "zone": zone, "released": released} | arm


def _known(table: Table, what: str, names: list[str]) -> str:
    """Return the name of a block or a zone that there is."""
    name = table.text(what, LONGEST_NAME)
    if name not in names:
        raise table.unknown(what, what, name, names)
    return name


def _arm(table: Table, both: bool) -> Side | None:
    if "arm" not in table.values:
        table.asked.add("arm")
        return None
    arm: Side = "left" if table.one_of("arm", SIDES) == "left" else "right"
    if not both:
        raise table.wrong(
            "arm", "only a scene that has both_arms = true names an arm: leave it out"
        )
    return arm


def _named(
    top: Table, key: str, build: Callable[[Table], _Named], most: int, needed: bool
) -> tuple[_Named, ...]:
    """Return what the tables [[key]] tell, each with a name of its own."""
    found: list[_Named] = []
    for table in _few(top, key, most, needed):
        each = build(table)
        table.end()
        if each.name in [other.name for other in found]:
            raise table.wrong("name", f"another {key} is called {each.name!r}, too: rename one")
        found.append(each)
    return tuple(found)


def _few(top: Table, key: str, most: int, needed: bool) -> list[Table]:
    tables = top.tables(key, needed)
    if len(tables) > most:
        raise top.wrong(key, f"expected {most} of them at most, found {len(tables)}")
    return tables


def _triple(table: Table, key: str, within: Range) -> Triple:
    x, y, z = table.numbers(key, 3, within)
    return x, y, z


def _pair(table: Table, key: str, within: Range) -> Pair:
    x, y = table.numbers(key, 2, within)
    return x, y
