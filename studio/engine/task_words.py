"""How one says that a scene's task is done: of the paper's task, that the block is down."""

from dataclasses import dataclass

from studio.engine.scene import Scene
from studio.engine.success import PUSH_DOWN


@dataclass(frozen=True)
class TaskWords:
    """Each pair is for done, and for not done."""

    what: str  # whose column it is in a table
    watched: str
    short: tuple[str, str]
    state: tuple[str, str]
    sentence: tuple[str, str]
    verdict: tuple[str, str]  # on what a robot made of it
    event: tuple[str, str]  # what happens
    verb: tuple[str, str]  # the same without what it happens to
    said: tuple[str, str]  # the same as one guesses it
    by_name: str  # at the head of a line
    question: str

    def told(self, done: bool, missing: str = "") -> str:
        """Return a sentence, and what is missing where nobody would guess it."""
        return self.sentence[not done] + self._missing(done, missing)

    def judged(self, done: bool, missing: str = "") -> str:
        """Return a verdict, with its sign, and what is missing where nobody would guess it."""
        sign = "✔" if done else "✖"
        return f"{sign} {self.verdict[not done]}{self._missing(done, missing)}"

    def marked(self, done: bool) -> str:
        """Return whether it was done, as short as can be."""
        return f"{'✔' if done else '✖'} {self.short[not done]}"

    def _missing(self, done: bool, missing: str) -> str:
        told = missing and not done and self.what != "block"
        return f" {missing[0].upper()}{missing[1:]}." if told else ""


BLOCK = TaskWords(
    what="block",
    watched="block",
    short=("down", "stands"),
    state=("block down", "block stands"),
    sentence=("The block is down.", "The block stands."),
    verdict=("The block is down.", "The block still stands."),
    event=("the block falls", "the block stays up"),
    verb=("falls", "stays up"),
    said=("it falls", "it stays up"),
    by_name="Block down",
    question="will the block fall?",
)
TASK = TaskWords(
    what="task",
    watched="blocks",
    short=("done", "not done"),
    state=("task done", "task not done"),
    sentence=("The task is done.", "The task is not done."),
    verdict=("The task is done.", "The task is not done."),
    event=("the task gets done", "the task does not get done"),
    verb=("gets done", "not done"),
    said=("it gets done", "it does not"),
    by_name="Task done",
    question="will the task get done?",
)


def task_words(scene: Scene) -> TaskWords:
    """Return the words for a scene."""
    return BLOCK if scene.success == PUSH_DOWN else TASK
