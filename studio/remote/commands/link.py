"""Commands as messages. Written by docs/make_remote_schema.py: change it there."""

from studio.remote.message import Message, Text


class ConnectLink(Message, frozen=True):
    """Listen to a robot: rosbridge://HOST:9090, coppeliasim://HOST:23000 or simulated://."""

    url: Text


class DisableLink(Message, frozen=True):
    """Stop, and take the power off its motors."""


class DisconnectLink(Message, frozen=True):
    """Let the robot alone; it holds still."""


class EnableLink(Message, frozen=True):
    """Let the robot power its motors; nothing is sent yet."""


class SetLinkSpeed(Message, frozen=True):
    """Let the robot use another share of its top speed."""

    ratio: float


class StartLink(Message, frozen=True):
    """Let the robot go slowly to where the page's robot is, once a person has confirmed it."""

    confirmed: bool = False  # that nobody is near, the desk is clear and the e-stop is at hand


class StopLink(Message, frozen=True):
    """Send nothing more; it has to be enabled and confirmed anew. Its motors keep their power."""
