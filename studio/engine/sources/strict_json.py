"""Values out of JSON of unknown origin, each checked before it is believed."""

import json
import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import TypeGuard

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.skeleton import JOINT_COUNT, FloatArray, Joint
from studio.engine.sources.family import shown


def parse_json(text: str) -> object:
    """Return the value that a JSON text holds; raise StudioError that names the place otherwise.

    NaN and Infinity pass here: whoever uses a number checks it and knows what to call it.
    """
    try:
        value: object = json.loads(text)
    except json.JSONDecodeError as error:
        # A text that ends within quotes is told by where they open.
        at_end = error.pos >= len(text.rstrip()) or error.msg.startswith("Unterminated string")
        cut = " (the text ends there: the file seems to be cut off)" if at_end else ""
        raise StudioError(
            f"line {error.lineno}, column {error.colno}: expected valid JSON, "
            f"found {shown(text[error.pos : error.pos + 20])}: {error.msg}{cut}"
        ) from None
    except RecursionError:
        raise StudioError("expected a recording, found JSON nested too deeply") from None
    except ValueError as error:  # a whole number of thousands of digits
        raise StudioError(f"expected numbers of usual length: {error}") from None
    return value


def json_lines(lines: Iterable[str]) -> Iterator[tuple[str, object]]:
    """Yield each line's place, such as ``line 3``, and value; blank lines are passed over.

    Raises
    ------
    StudioError
        Where a line is not JSON; the message names it.
    """
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        place = f"line {number}"
        try:
            value = parse_json(line)
        except StudioError as error:  # its "line 1" would mislead here
            raise StudioError(f"{place}: {str(error).removeprefix('line 1, ')}") from None
        yield place, value


def json_entries(text: str) -> Iterator[tuple[str, object]]:
    """Yield the place, such as ``entry 3`` (from 0), and the value of each entry of a JSON list."""
    for number, value in enumerate(as_list(parse_json(text), "the recording")):
        yield f"entry {number}", value


def as_object(value: object, what: str) -> dict[str, object]:
    """Return a JSON object; raise StudioError where the value is something else."""
    if not isinstance(value, dict):
        raise StudioError(f"expected {what} as an object, found {shown(value)}")
    return value


def as_list(value: object, what: str, length: int | None = None) -> list[object]:
    """Return a JSON list, of that length if one is given; raise StudioError otherwise."""
    if not isinstance(value, list):
        raise StudioError(f"expected {what} as a list, found {shown(value)}")
    if length is not None and len(value) != length:
        raise StudioError(f"expected {length} {what}, found {len(value)}")
    return value


def as_number(value: object, what: str) -> float:
    """Return a finite number; raise StudioError for anything else, true and "1" included."""
    if not _is_finite_number(value):
        raise StudioError(f"expected {what} as a finite number, found {shown(value)}")
    return float(value)


def as_numbers(values: object, what: str, count: int | None = None) -> FloatArray:
    """Return a list of finite numbers, ``count`` of them if given; raise StudioError otherwise."""
    given = as_list(values, what, count)
    if not (set(map(type, given)) == {float} and _all_finite(given)):
        each = f"each of {what}"
        given = [as_number(value, each) for value in given]
    return np.array(given, dtype=np.float64)


def as_flag(value: object, what: str) -> bool:
    """Return true or false; raise StudioError for anything else, 0 and 1 included."""
    if not isinstance(value, bool):
        raise StudioError(f"expected {what} as true or false, found {shown(value)}")
    return value


def as_text(value: object, what: str) -> str:
    """Return a text that can be printed; raise StudioError for half of a character, too."""
    if not isinstance(value, str) or any("\ud800" <= letter <= "\udfff" for letter in value):
        raise StudioError(f"expected {what} as a text, found {shown(value)}")
    return value


def as_positions(points: Sequence[Sequence[object]]) -> FloatArray:
    """Return the positions (25, 3) [m]; raise StudioError that names the joint otherwise."""
    every = list(chain.from_iterable(points))
    if set(map(type, every)) == {float} and len(every) == 3 * JOINT_COUNT and _all_finite(every):
        return np.array(points, dtype=np.float64).reshape(JOINT_COUNT, 3)  # as nearly always
    for joint, point in zip(Joint, points, strict=True):
        for axis, value in zip("xyz", point, strict=True):
            if not _is_finite_number(value):
                raise StudioError(
                    f"joint {joint.value} ({joint.name.lower()}): expected {axis} "
                    f"as a finite number, found {shown(value)}"
                )
    return np.array(points, dtype=np.float64).reshape(JOINT_COUNT, 3)


def _all_finite(numbers: list[object]) -> bool:
    """Tell whether floats are finite: fast, as recordings hold a million of them."""
    return all(map(math.isfinite, numbers))  # type: ignore[arg-type]  # whoever asks has looked


def _is_finite_number(value: object) -> TypeGuard[int | float]:
    if type(value) is float:
        return math.isfinite(value)
    return type(value) is int and abs(value) < 2**1023  # a larger one is no float
