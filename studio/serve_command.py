"""``studio serve``: the studio in the browser, for programs, or for both."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from studio.engine.errors import StudioError
from studio.engine.live.access import Address
from studio.engine.resources import recordings_folder
from studio.stream_token import stream_token

# The help is that of --no-browser, the only way to say it; likewise below.
BrowserFlag = Annotated[
    bool,
    tyro.conf.arg(help="Only print the page's address, open no browser.", help_behavior_hint=""),
]
PageFlag = Annotated[
    bool,
    tyro.conf.arg(help="Serve no page: programs alone reach it.", help_behavior_hint=""),
]


@dataclass(frozen=True)
class Serve:
    """Open the studio in the browser (what plain `studio` does)."""

    host: str = "127.0.0.1"
    """Address to listen on. Anything but loopback lets others in, without a password."""
    port: int = 8080
    """Port to listen on; the next free one if it is taken."""
    recordings: Path | None = None
    """Folder for new recordings. In a clone its recordings folder, else the user's data folder."""
    browser: BrowserFlag = True
    page: PageFlag = True
    listen: str | None = None
    """HOST:PORT to take live streams at, 127.0.0.1:8765 or the next free port by default. Beyond
    this machine it needs a token."""
    remote: str | None = None
    """HOST:PORT to let programs in at, such as 127.0.0.1:8766: docs/remote.md. Beyond this machine
    it needs a token."""
    token: str | None = None
    """What publishers and programs have to present: ws://...?token=TOKEN or Authorization: Bearer
    TOKEN. Better set STUDIO_TOKEN: other users of this machine can read what is typed here."""
    robot: str | None = None
    """A robot to go along: rosbridge://HOST:9090, coppeliasim://HOST:23000 or simulated://. It
    moves only once you have enabled it and confirmed its first move: docs/links.md."""

    def run(self) -> int:
        """Serve until interrupted."""
        from studio.running import Doors, serve_programs  # noqa: PLC0415 - other commands need none

        folder = self.recordings or recordings_folder()
        streams = None if self.listen is None else Address.parse(self.listen)
        remote = None if self.remote is None else Address.parse(self.remote, "--remote")
        doors = Doors(streams, remote, stream_token(self.token), self.robot)
        if self.page:
            from studio.live import serve_studio  # noqa: PLC0415 - the only one to need viser

            serve_studio(self.host, self.port, folder, self.browser, doors)
        elif remote is None:
            raise StudioError(
                "--no-page: then only programs reach the studio: add --remote 127.0.0.1:8766"
            )
        else:
            serve_programs(folder, doors)
        return 0
