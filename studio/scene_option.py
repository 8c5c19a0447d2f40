"""The scene, as an option of the commands that teach."""

from typing import Annotated

import tyro

SceneFlag = Annotated[
    str,
    tyro.conf.arg(
        metavar="NAME|FILE",
        help="What stands around Baxter, and what is to be done: push-down (the paper's), "
        "push-into-zone, two-in-order, pick-and-place, both-arms, or a TOML file of your own. Arms "
        "and gripper are as it takes them; a recording made in another scene is followed anew.",
    ),
]
