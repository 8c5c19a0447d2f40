"""What people let a robot beyond the simulator do; see `engine.links`."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ConnectLink:
    """Listen to a robot: rosbridge://HOST:9090, coppeliasim://HOST:23000 or simulated://."""

    url: str


@dataclass(frozen=True)
class DisconnectLink:
    """Let the robot alone; it holds still."""


@dataclass(frozen=True)
class EnableLink:
    """Let the robot power its motors; nothing is sent yet."""


@dataclass(frozen=True)
class StartLink:
    """Let the robot go slowly to where the page's robot is, once a person has confirmed it."""

    confirmed: bool = False  # that nobody is near, the desk is clear and the e-stop is at hand


@dataclass(frozen=True)
class SetLinkSpeed:
    """Let the robot use another share of its top speed."""

    ratio: float


@dataclass(frozen=True)
class StopLink:
    """Send nothing more; it has to be enabled and confirmed anew. Its motors keep their power."""


@dataclass(frozen=True)
class DisableLink:
    """Stop, and take the power off its motors."""


LinkCommand = (
    ConnectLink | DisconnectLink | EnableLink | StartLink | SetLinkSpeed | StopLink | DisableLink
)
