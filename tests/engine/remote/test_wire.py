"""Between data classes and messages: nothing goes astray, whatever the command."""

import dataclasses
from enum import Enum
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import msgspec
import numpy as np
import pytest

from studio.engine import commands as engine
from studio.engine.errors import StudioError
from studio.engine.remote.wire import as_command, as_message, readable
from studio.engine.scene import Scene
from studio.remote import commands
from studio.remote.files import Sample
from studio.remote.place import LinkedRobot
from studio.remote.snapshot import News

PLACE = Path("/somewhere/upload-1")


def example(hint: Any) -> Any:  # noqa: PLR0911 - one for each kind
    """A value of an engine's type that is no default."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType):
        return example(next(each for each in inner if each is not NoneType))
    if origin is Literal:
        return inner[-1]
    if origin is tuple:
        each = [example(one) for one in inner if one is not ...]
        return tuple(each)
    if hint is Path:
        return PLACE
    if isinstance(hint, type) and issubclass(hint, Enum):
        return list(hint)[-1]
    if hint.__name__ == "Calibration":
        return hint((0.0, 0.0, -1.0))
    if dataclasses.is_dataclass(hint):
        return example_of(hint)
    known = {str: "words", int: 7, float: 0.25, bool: True}
    return known.get(hint, {"left_s0": 0.25})


def example_of(kind: type) -> Any:
    hints = get_type_hints(kind)
    names = [field.name for field in dataclasses.fields(kind) if hints[field.name] is not Scene]
    return kind(**{name: example(hints[name]) for name in names})


def as_sent(command: Any) -> dict[str, Any]:
    """The JSON that means a command, written down in another way than the engine's."""
    found: dict[str, Any] = {}
    for field in dataclasses.fields(command):
        value = getattr(command, field.name)
        if isinstance(value, Path):
            found["file"] = {"type": "sample", "name": value.name}
        elif isinstance(value, Scene):
            continue
        elif dataclasses.is_dataclass(value):
            found[field.name] = as_sent(value)
        else:
            found[field.name] = value
    if "file" in found:
        found.pop("name", None)
    return found


@pytest.mark.parametrize("kind", get_args(engine.Command), ids=lambda kind: kind.__name__)
def test_a_command_comes_over_as_it_was_meant(kind: type) -> None:
    meant = example_of(kind)
    tag = getattr(commands, kind.__name__).__struct_config__.tag
    text = msgspec.json.encode({"type": tag, **as_sent(meant)})
    message = msgspec.json.decode(text, type=commands.Command)
    assert as_command(message, lambda _: (PLACE, "words")) == meant


def test_what_a_value_cannot_be_is_said_by_the_engine() -> None:
    with pytest.raises(StudioError, match="neurons: 1 to 1000"):
        as_command(commands.Train(commands.LearnerSettings("rbf", 0)), lambda _: (PLACE, ""))
    with pytest.raises(StudioError, match="no such"):
        as_command(commands.UseFile(Sample("x")), _no_such)


def _no_such(_: object) -> tuple[Path, str]:
    raise StudioError("no such file")


@dataclasses.dataclass
class Told:
    number: int = 3
    text: str = "words"
    is_error: bool = False


def test_a_message_takes_each_field_by_its_name() -> None:
    assert as_message(News, Told(), {}) == News(3, "words", False)
    assert as_message(News, Told(), {News: lambda _: {"text": "else"}}).text == "else"
    assert as_message(News, Told(), {}, number=9).number == 9
    with pytest.raises(AttributeError, match="is_error"):
        as_message(News, dataclasses.make_dataclass("Less", ["number", "text"])(1, ""), {})


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_no_number_that_json_does_not_know_is_told(wrong: float) -> None:
    from studio.remote.place import World  # noqa: PLC0415

    fine = {
        "time": 0.0,
        "joint_positions": np.zeros(15),
        "joint_velocities": np.zeros(15),
        "block_poses": np.zeros((2, 7)),
        "touched": False,
        "tilt": 0.0,
        "block_down": False,
        "done": False,
        "missing": "",
        "fingers": np.empty(0),
    }
    assert as_message(World, None, {}, **fine).joint_positions == [0.0] * 15
    for change in ({"tilt": wrong}, {"joint_positions": np.full(15, wrong)}):
        with pytest.raises(ValueError, match="not finite"):
            as_message(World, None, {}, **{**fine, **change})


def test_where_nobody_knows_a_joint_it_is_null() -> None:
    hints = get_type_hints(LinkedRobot)
    assert hints["measured"] == list[float | None] | None
    robot = dict.fromkeys(LinkedRobot.__struct_fields__, "")
    robot |= dict.fromkeys(("is_connected", "is_enabled", "resets", "is_moving"), False)
    robot |= {"ratio": 0.3, "lag": 0.0, "measured": np.array([0.1, np.nan])}
    assert as_message(LinkedRobot, None, {}, **robot).measured == [0.1, None]


def test_a_file_s_name_may_have_bytes_that_are_no_characters() -> None:
    assert readable("r\udcff.mcap") == "r?.mcap"
    assert readable("Größe.mcap") == "Größe.mcap"
    told = as_message(News, Told(text="r\udcff"), {})
    assert msgspec.json.decode(msgspec.json.encode(told))["text"] == "r?"
