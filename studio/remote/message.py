"""What all messages are: JSON objects that say by their ``type`` which one they are."""

import re
from typing import Annotated

import msgspec

Text = Annotated[str, msgspec.Meta(max_length=1000)]  # that a program sends
Id = Annotated[int, msgspec.Meta(ge=0, le=2**53 - 1)]  # what JavaScript counts exactly


def tag_of(name: str) -> str:
    """Return the ``type`` of a message class: ``SetJointTarget`` is ``set_joint_target``."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What messages are made of."""


class Message(Part, frozen=True, tag_field="type", tag=tag_of):
    """A message, or a part that comes in several kinds."""
