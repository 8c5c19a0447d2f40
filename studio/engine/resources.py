"""Where the project's own data lie, installed or in a clone, and where a user's recordings go."""

from pathlib import Path

import platformdirs

_PACKAGE = Path(__file__).resolve().parent.parent


def resource_root() -> Path:
    """Return the folder that holds ``urdf``, ``seeds``, ``recordings/samples`` and ``NOTICE``.

    A wheel carries them under ``studio/data``; a clone (and so an editable install) has them at
    its top level.
    """
    packaged = _PACKAGE / "data"
    return packaged if packaged.is_dir() else _PACKAGE.parent


def notice_path() -> Path:
    """Return the file that names the maker of the robot's meshes, and their license."""
    return resource_root() / "NOTICE"


def samples_folder() -> Path:
    """Return the folder of the recordings that ship with the studio."""
    return resource_root() / "recordings" / "samples"


def recordings_folder() -> Path:
    """Return where a user's recordings go unless told otherwise.

    A clone keeps them in its ``recordings`` folder (ignored by git); an installed studio in the
    user's data folder, never in site-packages. The folder may not exist yet.
    """
    root = resource_root()
    if (root / "pyproject.toml").is_file():
        return root / "recordings"
    return platformdirs.user_data_path("teaching-studio") / "recordings"
