"""How takes are recorded: automatically while armed, by hand, or once more in another's place."""

from collections.abc import Callable
from pathlib import Path

from studio.engine.activity import Activity, Follow
from studio.engine.collection import Collection
from studio.engine.commands import BeginTake, EndTake, RecordAgain
from studio.engine.errors import NothingTaughtError, StudioError
from studio.engine.tape import LONGEST_RECORDING, NO_PLAN, Plan, Tape, next_recording_path


class Taking:
    """See the module; ``saved_as`` is the last recording's file."""

    def __init__(self, folder: Path, collection: Collection) -> None:
        self.saved_as = ""
        self._folder, self._collection = folder, collection

    def next_path(self) -> Path:
        """Return where the next recording goes; raise FileError where no name is left."""
        return next_recording_path(self._folder)

    def mark(self, activity: Activity, command: BeginTake | EndTake) -> str:
        """Begin or end a take by hand, and return in words what came of it.

        Raises
        ------
        StudioError
            Where nobody is watched, or nothing armed in the take.
        FileError
            Where it cannot be written.
        """
        if not isinstance(activity, Follow):
            raise StudioError("Press Watch first: a take is recorded by hand while you watch")
        if isinstance(command, EndTake):
            if activity.tape is None:
                raise StudioError("Begin a take first")
            return self.keep(activity.end_recording())
        if activity.tape is not None:
            raise StudioError("It is being recorded already: end that take first")
        activity.begin_recording(self.next_path())
        return "Recording this take, until you end it."

    def keep(self, tape: Tape | None) -> str:
        """List what was recorded, and return in words what came of it.

        Raises
        ------
        StudioError
            Where nothing armed in it, unless takes of the same run are listed.
        """
        if tape is None:
            return "Stopped watching."
        if not tape.samples:
            return ""
        self.saved_as = str(tape.path)
        most = f" {LONGEST_RECORDING // 60} minutes are the longest." if tape.is_long_enough else ""
        name, replaces = tape.path.stem, tape.plan.replaces
        try:
            return self._collection.add(tape.recording, name, tape.path, replaces) + most
        except StudioError as error:
            if tape.plan.goes_on and isinstance(error, NothingTaughtError):
                return f"Stopped. What came after the last take is kept as {tape.path.name}.{most}"
            raise StudioError(f"{error}.{most}" if most else str(error)) from error

    def again(self, activity: Activity, command: RecordAgain, finish: Callable[[], None]) -> Plan:
        """End what is being recorded by ``finish``; return what the next recording is for.

        What was being recorded is not thrown away: it is listed, and deleted, with undo, once the
        next one has taken its place.

        Raises
        ------
        StudioError
            Where there is no demonstration of that number.
        """
        listed = self._collection.listed
        tape = activity.tape if isinstance(activity, Follow) else None
        if tape is None:
            number = listed.chosen if command.number is None else command.number
            return Plan(listed.entry(number).number) if listed.entries else NO_PLAN
        before = listed.newest
        finish()
        replaces = tape.plan.replaces if listed.newest == before else listed.newest
        return Plan(replaces, tape.plan.repeats)
