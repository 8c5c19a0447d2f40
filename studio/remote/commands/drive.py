"""Commands as messages. Written by docs/make_remote_schema.py: change it there."""

from typing import Annotated

import msgspec

from studio.remote.message import Message, Text


class BeginDriving(Message, frozen=True):
    """Let joint targets count again: after a `Stop` none does, until this is asked for.

    The robot goes nowhere by it, only with the next target.
    """


class SetJointTarget(Message, frozen=True):
    """Let joints go somewhere, through limits and collision guard; the robot holds without news.

    The first one begins it, slowly. None at all is a sign of life: go on with the last ones.
    """

    # [rad] by joint, as left_s0
    targets: Annotated[dict[Text, float], msgspec.Meta(max_length=15)] = msgspec.field(
        default_factory=dict
    )
    closed: bool | None = None  # the grippers of the driven arms; None: as they are
