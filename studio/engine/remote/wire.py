"""Between the engine's data classes and their messages: field by field, by the same names.

So a field is written down in one place only, and nothing of a message goes astray in between.
"""

import math
from collections.abc import Callable, Hashable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import msgspec
import numpy as np

from studio.engine import commands
from studio.remote import commands as asked

_Part = TypeVar("_Part", bound=msgspec.Struct)
Adapters = Mapping[type[Any], Callable[[Any], dict[str, Any]]]  # what a message has by other names


def as_command(message: asked.Command, find: Callable[[Any], tuple[Path, str]]) -> commands.Command:
    """Return the engine's command that a message means.

    ``find`` returns where a file that it names lies, and what people call it.

    Raises
    ------
    StudioError
        Where a value is impossible, or there is no such file.
    """
    command: commands.Command = _built(getattr(commands, type(message).__name__), message, find)
    return command


def _built(kind: type[Any], message: Any, find: Callable[[Any], tuple[Path, str]]) -> Any:
    hints = get_type_hints(kind)
    values: dict[str, Any] = {}
    for field in fields(kind):
        hint = hints[field.name]
        if hint is Path:
            values["path"], values["name"] = find(message.file)
        elif field.name not in values and hasattr(message, field.name):
            values[field.name] = _value(hint, getattr(message, field.name), find)
    return kind(**values)


def _value(hint: Any, value: Any, find: Callable[[Any], tuple[Path, str]]) -> Any:
    for one in get_args(hint) if get_origin(hint) in (Union, UnionType) else (hint,):
        if is_dataclass(one) and isinstance(value, msgspec.Struct):
            return _built(one, value, find)  # type: ignore[arg-type] # a class, not an instance
        if isinstance(one, type) and issubclass(one, Enum) and value is not None:
            return one(value)
    return value


def readable(text: str) -> str:
    """Return a text as JSON can have it: a file's name may have bytes that are no characters."""
    return text.encode("utf-8", "replace").decode()


def as_message(kind: type[_Part], value: Any, adapters: Adapters, **more: Any) -> _Part:
    """Return a message of a kind, each of its fields from the value's attribute of that name.

    ``more`` fields are given, others ``adapters`` return, by the kind of a part.

    Raises
    ------
    ValueError
        Where a number is not finite that has to be.
    """
    hints = _hints(kind)
    found = adapters[kind](value) if kind in adapters else {}
    found = {**found, **more}
    made = {
        name: _told(hints[name], found[name] if name in found else getattr(value, name), adapters)
        for name in kind.__struct_fields__
        if name in found or hasattr(value, name) or name not in _optional(kind)
    }
    return kind(**made)


@cache
def _optional(kind: type[msgspec.Struct]) -> frozenset[str]:
    count = len(kind.__struct_defaults__)
    return frozenset(kind.__struct_fields__[-count:] if count else ())


def _told(hint: Any, value: Any, adapters: Adapters) -> Any:
    """Return a value as a field of a message has it."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return _told(inner[0], value, adapters)
    if origin in (Union, UnionType):
        (known,) = (each for each in inner if each is not NoneType)
        missing = value is None or (known is float and not math.isfinite(value))
        return None if missing else _told(known, value, adapters)
    if origin in (list, tuple, dict):
        return _many(origin, inner, value, adapters)
    if isinstance(hint, type) and issubclass(hint, msgspec.Struct):
        return value if isinstance(value, hint) else as_message(hint, value, adapters)
    if hint is float and not math.isfinite(value):
        raise ValueError(f"a number that is not finite cannot be told: {value}")
    if origin is Literal or hint is str:
        return readable(value.name if isinstance(value, Path) else str(value))
    return hint(value) if hint in (float, int, bool) else value


def _many(origin: Any, inner: tuple[Any, ...], value: Any, adapters: Adapters) -> Any:
    if isinstance(value, np.ndarray):
        if inner == (float | None,):  # numbers that nobody knows are NaN
            return [None if math.isnan(each) else each for each in value.tolist()]
        if not np.isfinite(value).all():
            raise ValueError("numbers that are not finite cannot be told")
        return value.tolist()
    if origin is dict:
        return {_key(key): _told(inner[1], each, adapters) for key, each in value.items()}
    if origin is tuple and ... not in inner:
        return tuple(_told(hint, each, adapters) for hint, each in zip(inner, value, strict=True))
    return origin(_told(inner[0], each, adapters) for each in value)


def _key(key: Any) -> str:
    return key.name.lower() if isinstance(key, Enum) else str(key)


@cache
def _hints(kind: Hashable) -> dict[str, Any]:
    return get_type_hints(kind)
