"""What can go wrong, as one small tree. Each message names the file, the place and the cure.

StudioError
├── FileError          a file that cannot be used: skeletons, recordings, models
└── NothingTaughtError a stream in which nothing armed, or too little to learn from
"""


class StudioError(Exception):
    """Base of all errors that a person can cure; the command line prints them without traceback."""


class FileError(StudioError):
    """A file that cannot be used; the message names it, the place in it, and what was expected."""


class NothingTaughtError(StudioError):
    """Nothing armed, or what was recorded is too little to learn from."""
