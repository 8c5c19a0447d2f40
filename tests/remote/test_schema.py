"""What follows from the engine's commands is in the repository as they are by now."""

import dataclasses
import importlib.util
import json
import random
import string
from pathlib import Path
from typing import Any, get_args

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from studio.engine import commands as engine
from studio.engine.snapshot import Snapshot
from studio.remote import asked, commands, snapshot, told
from studio.remote.message import tag_of

ROOT = Path(__file__).resolve().parents[2]
AGAIN = "run: python docs/make_remote_schema.py"


@pytest.fixture(scope="module")
def maker() -> Any:
    path = ROOT / "docs" / "make_remote_schema.py"
    spec = importlib.util.spec_from_file_location("make_remote_schema", path)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_commands_are_those_of_the_engine(maker: Any) -> None:
    there = {path.name: path.read_text() for path in maker.COMMANDS.glob("*.py")}
    assert there == maker.command_modules(), AGAIN
    ours = {each.__name__ for each in get_args(engine.Command)}
    assert {each.__name__ for each in get_args(commands.Command)} == ours


def test_the_schema_is_that_of_the_messages(maker: Any) -> None:
    assert maker.SCHEMA.read_text() == maker.schema_text(), AGAIN
    Draft202012Validator.check_schema(json.loads(maker.SCHEMA.read_text()))


def test_the_pages_tables_are_those_of_the_messages(maker: Any) -> None:
    text = maker.PAGE.read_text()
    assert text == maker.page(text), AGAIN
    for union in (asked.Asked, commands.Command, told.Told):
        for each in get_args(union):
            assert f"| `{tag_of(each.__name__)}` |" in text


def test_all_of_a_snapshot_goes_over_the_wire() -> None:
    ours = {each.name for each in dataclasses.fields(Snapshot)}
    assert set(snapshot.Snapshot.__struct_fields__) - {"tick", "id", "missed"} == ours


def test_every_field_of_a_command_is_in_its_message() -> None:
    for each in get_args(engine.Command):
        message = getattr(commands, each.__name__).__struct_fields__
        for field in dataclasses.fields(each):
            named = "file" if field.name in ("path", "name") and "file" in message else field.name
            assert named in message, (each.__name__, field.name)


# Two roads to one answer: what msgspec takes, the schema allows.

EXAMPLES = [
    '{"type":"do","id":1,"command":{"type":"use_file","file":{"type":"sample","name":"a"}}}',
    '{"type":"do","command":{"type":"configure","choices":{"arms":"both","hands":{}}}}',
    '{"type":"do","command":{"type":"drag_hand","side":"left","point":[0.1,0.2,2.0]}}',
    '{"type":"set_joint_target","targets":{"left_s0":0.5},"closed":null}',
    '{"type":"subscribe","id":3,"stream":"gate","rate":7.5}',
    '{"type":"take_clock","id":9,"patience":1.5}',
    '{"type":"upload","id":4,"content":"AAEC","name":"x","upload":null}',
]
READ = msgspec.json.Decoder(asked.Asked)
ALLOWED = json.loads((ROOT / "docs" / "remote.schema.json").read_text())
ALLOWED["anyOf"] = [{"$ref": "#/$defs/Asked"}]
ALLOWS = Draft202012Validator(ALLOWED)


def mutated(text: str, seed: int) -> str:
    chance = random.Random(seed)
    letters = list(text)
    for _ in range(chance.randint(0, 3)):
        place = chance.randrange(len(letters))
        letters[place] = chance.choice(["", *'{}[]":,-01289.e', *string.ascii_letters[:6], "null"])
    return "".join(letters)


@settings(deadline=None, derandomize=True, max_examples=400)
@given(st.sampled_from(EXAMPLES), st.integers(0, 10**6))
def test_what_is_understood_is_documented(example: str, seed: int) -> None:
    text = mutated(example, seed)
    try:
        READ.decode(text)
    except (msgspec.MsgspecError, UnicodeError):
        return
    assert ALLOWS.is_valid(json.loads(text)), text


@pytest.mark.parametrize("example", EXAMPLES)
def test_the_examples_themselves_are_both(example: str) -> None:
    READ.decode(example)
    assert ALLOWS.is_valid(json.loads(example))
