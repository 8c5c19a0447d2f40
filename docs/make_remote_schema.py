"""Writes all of the remote interface that follows from the engine's commands and the messages.

- ``studio/remote/commands/``: every command of the engine as a message, so that the client knows
  them without the engine;
- ``docs/remote.schema.json``: the JSON Schema of all messages;
- the tables in ``docs/remote.md``.

Run it after a change of a command or of a message: ``python docs/make_remote_schema.py``.
"""

import dataclasses
import inspect
import json
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from enum import Enum
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import msgspec  # noqa: E402

from studio.engine import commands  # noqa: E402
from studio.engine.robot import JOINT_NAMES  # noqa: E402

COMMANDS = ROOT / "studio" / "remote" / "commands"
SCHEMA = ROOT / "docs" / "remote.schema.json"
PAGE = ROOT / "docs" / "remote.md"

_HEAD = '"""{words} Written by docs/make_remote_schema.py: change it there."""\n'
_BARE_PARTS = "parts"  # the module of what commands are made of
# What a module may need, in the order of its imports.
_IMPORTS = {
    r"\b(?:Annotated|Literal)\b": "from typing import {names}\n",
    r"\bmsgspec\b": "import msgspec\n",
    r"\b(?:File|Place)\b": "from studio.remote.files import {names}",
    r"\b(?:Message|Part|Text)\b": "from studio.remote.message import {names}",
}
_GENERIC: dict[Any, str] = {tuple: "tuple", Mapping: "dict"}
_WIDTH = 100  # characters of a line
_LEFT_OUT = {("Choices", "scene")}  # chosen by a command of its own, told by the snapshot itself
_BY_NAME = ("Scene",)  # which the engine has at hand, and a program names
_PLACED = "AddFrom"  # may read what the browser's user may type: a path on the studio's machine


def classes() -> list[type[Any]]:
    """Return all commands of the engine, by name."""
    return sorted(get_args(commands.Command), key=lambda each: each.__name__)


def command_modules() -> dict[str, str]:
    """Return the texts of ``studio/remote/commands/``, by the names of the files.

    The engine's commands have modules of the same names.
    """
    known: dict[type[Any], str] = {}
    for each in classes():
        _define(each, known, "Message")
    parts = {kind: text for kind, text in known.items() if kind not in classes()}
    texts = {_BARE_PARTS: _module("What commands are made of.", "\n\n".join(parts.values()), [])}
    names = [kind.__name__ for kind in parts]
    for module in sorted({_module_of(each) for each in classes()}):
        mine = [known[each] for each in classes() if _module_of(each) == module]
        texts[module] = _module("Commands as messages.", "\n\n".join(mine), names)
    texts["__init__"] = _package(list(parts))
    return {f"{name}.py": formatted(text) for name, text in texts.items()}


def _module_of(kind: type[Any]) -> str:
    return kind.__module__.rpartition(".")[2]


def _module(words: str, body: str, parts: list[str]) -> str:
    """Return a module: its words, the imports that it needs, and its body."""
    code = re.sub(r'(?s:""".*?""")|#.*', "", body)
    lines = [
        line.format(names=", ".join(sorted(set(re.findall(pattern, code)))))
        for pattern, line in _IMPORTS.items()
        if re.search(pattern, code)
    ]
    used = sorted(name for name in parts if re.search(rf"\b{name}\b", code))
    if used:
        lines.append(f"from studio.remote.commands.{_BARE_PARTS} import {', '.join(used)}")
        lines.sort(key=lambda line: line.startswith("from studio.remote.message"))
        lines.sort(
            key=lambda line: line.startswith(
                ("from studio.remote.files", "from studio.remote.message")
            )
        )
    return "\n".join([_HEAD.format(words=words), *lines, "\n", body])


def _package(parts: list[type[Any]]) -> str:
    """Return the package's own module: all commands, and their union."""
    home = {each.__name__: _module_of(each) for each in classes()}
    home |= {each.__name__: _BARE_PARTS for each in parts}
    imports = [
        f"from studio.remote.commands.{module} import "
        + ", ".join(sorted(name for name in home if home[name] == module))
        for module in sorted(set(home.values()))
    ]
    union = "Command = (\n    " + "\n    | ".join(each.__name__ for each in classes()) + "\n)\n"
    listed = "".join(f'    "{name}",\n' for name in sorted([*home, "Command"]))
    head = _HEAD.format(words="All commands as messages.")
    return "\n".join([head, *imports, "", union, f"__all__ = [\n{listed}]\n"])


def formatted(text: str) -> str:
    """Return a module's text as the house formats it."""
    done = subprocess.run(
        [sys.executable, "-m", "ruff", "format", "--stdin-filename", "commands.py", "-"],
        input=text,
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT,
    )
    return done.stdout


def _define(kind: type[Any], known: dict[type[Any], str], base: str) -> None:
    """Add the definition of a data class, after those that it needs."""
    if kind in known:
        return
    hints, lines = get_type_hints(kind), []
    for field in dataclasses.fields(kind):
        hint = hints[field.name]
        if (kind.__name__, field.name) in _LEFT_OUT:
            continue
        if hint is Path:
            lines.append(f"    file: {'Place' if kind.__name__ == _PLACED else 'File'}")
        elif not (field.name == "name" and Path in hints.values()):  # the file says its name
            for part in _parts(hint):
                _define(part, known, "Part")
            lines += _commented(f"    {field.name}: {_written(hint)}{_default(field)}", kind)
    words = inspect.cleandoc(kind.__doc__ or "").split("\n\nRaises")[0]
    words = "\n    ".join(words.splitlines()).replace("\n    \n", "\n\n")
    closed = f'"""{words}"""' if "\n" not in words else f'"""{words}\n    """'
    body = "\n".join(lines)
    known[kind] = f"class {kind.__name__}({base}, frozen=True):\n    {closed}\n\n{body}\n"


def _commented(line: str, kind: type[Any]) -> list[str]:
    """Return a field's line with the comment that the engine's has."""
    name = line.split(":", maxsplit=1)[0].strip()
    found = re.search(rf"^    {name}: .*?  # (.*)$", inspect.getsource(kind), re.MULTILINE)
    if found is None:
        return [line]
    together = f"{line}  # {found[1]}"
    return [together] if len(together) <= _WIDTH else [f"    # {found[1]}", line]


def _parts(hint: Any) -> Iterator[type[Any]]:
    if dataclasses.is_dataclass(hint) and hint.__name__ not in _BY_NAME:
        yield hint  # type: ignore[misc] # a class, not an instance
    for inner in get_args(hint):
        if not isinstance(inner, str):
            yield from _parts(inner)


def _written(hint: Any) -> str:
    """Return a type as the message has it."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType):
        return " | ".join(dict.fromkeys(map(_written, inner)))
    if origin is Literal:
        return f"Literal[{', '.join(map(json.dumps, inner))}]"
    if origin in _GENERIC:
        parts = ("..." if each is ... else _written(each) for each in inner)
        whole = f"{_GENERIC[origin]}[{', '.join(parts)}]"
        if origin is Mapping:  # by joint
            return f"Annotated[{whole}, msgspec.Meta(max_length={len(JOINT_NAMES)})]"
        return whole
    if issubclass(hint, Enum):
        return f"Literal[{', '.join(json.dumps(each.value) for each in hint)}]"
    named = "Text" if hint.__name__ in _BY_NAME else str(hint.__name__)
    return {NoneType: "None", str: "Text"}.get(hint, named)


def _default(field: "dataclasses.Field[Any]") -> str:
    if field.default_factory is not dataclasses.MISSING:
        return " = msgspec.field(default_factory=dict)"
    if field.default is dataclasses.MISSING:
        return ""
    if dataclasses.is_dataclass(field.default):
        return f" = {type(field.default).__name__}()"
    return (
        f" = {json.dumps(field.default)}"
        if isinstance(field.default, str)
        else (f" = {field.default!r}")
    )


def schema() -> dict[str, Any]:
    """Return the JSON Schema of all messages: ``Asked`` by programs, ``Told`` by the studio."""
    from studio.remote.asked import Asked  # noqa: PLC0415 - needs the commands as they are by now
    from studio.remote.told import Told  # noqa: PLC0415

    (asked, told), parts = msgspec.json.schema_components([Asked, Told])
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "The teaching studio's messages for programs",
        "anyOf": [{"$ref": "#/$defs/Asked"}, {"$ref": "#/$defs/Told"}],
        "$defs": {**parts, "Asked": asked, "Told": told},
    }


def schema_text() -> str:
    """Return the text of ``docs/remote.schema.json``."""
    return json.dumps(schema(), indent=1, ensure_ascii=False) + "\n"


def page(before: str) -> str:
    """Return the text of ``docs/remote.md`` with its tables anew."""
    from studio.remote import asked, commands, told  # noqa: PLC0415 - as above

    unions = {"asked": asked.Asked, "commands": commands.Command, "told": told.Told}
    for name, union in unions.items():
        rows = "\n".join(_row(each) for each in get_args(union))
        table = f"| `type` | fields | |\n|---|---|---|\n{rows}\n"
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
        pattern = f"{re.escape(begin)}.*?{re.escape(end)}"
        before = re.sub(pattern, lambda _, t=begin + table + end: t, before, flags=re.DOTALL)
    return before


def _row(kind: type[msgspec.Struct]) -> str:
    """Return a message's line: fields with ? may be left out."""
    shown = [
        f"`{each.name}`" if each.required else f"`{each.name}`?"
        for each in msgspec.structs.fields(kind)
    ]
    words = inspect.cleandoc(kind.__doc__ or "").replace("|", "\\|").replace("``", "`")
    return f"| `{kind.__struct_config__.tag}` | {', '.join(shown)} | {' '.join(words.split())} |"


def main() -> None:
    """Write them."""
    COMMANDS.mkdir(exist_ok=True)
    for name, text in command_modules().items():
        (COMMANDS / name).write_text(text)
    SCHEMA.write_text(schema_text())
    PAGE.write_text(page(PAGE.read_text()))


if __name__ == "__main__":
    main()
