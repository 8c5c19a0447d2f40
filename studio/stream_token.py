"""The token of live streams: as an option, or out of the environment, where others can't see it."""

import os

VARIABLE = "STUDIO_TOKEN"  # the bridges look there, too


def stream_token(option: str | None) -> str | None:
    """Return the token that was given as ``--token``, else that of the environment, if any."""
    return option if option is not None else os.environ.get(VARIABLE) or None
