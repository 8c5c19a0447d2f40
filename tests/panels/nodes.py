"""A stand-in for viser's scene: it keeps every node by its name, and what became of it."""

import asyncio
from types import SimpleNamespace

import numpy as np


class Node(SimpleNamespace):
    """Any node."""

    def remove(self) -> None:
        self.scene.nodes.pop(self.name)

    def on_drag(self, _: str, modifier: str | None = None):
        def keep(act):
            self.drags[modifier] = act
            return act

        return keep

    def drag(self, phase: str, pointer, eye, modifier: str | None = None) -> None:
        """Drag it as viser would, whose loop waits for each callback."""
        client = SimpleNamespace(camera=SimpleNamespace(position=tuple(eye)))
        event = SimpleNamespace(
            phase=phase, client=client, client_id=1, end_position=tuple(pointer)
        )
        asyncio.run(self.drags[modifier](event))


class Scene:
    """See the module."""

    def __init__(self) -> None:
        self.nodes: dict[str, Node] = {}
        self.added = 0

    def _add(self, name: str, *args: object, **props: object) -> Node:
        names = ("vertices", "faces") if len(args) == 2 else ("points",)
        given = {"position": np.zeros(3), "visible": True} | dict(zip(names, args, strict=False))
        self.nodes[name] = Node(scene=self, name=name, drags={}, **(given | props))
        self.nodes[name].position = np.array(self.nodes[name].position, dtype=float)
        self.added += 1
        return self.nodes[name]

    add_frame = add_box = add_label = add_icosphere = add_arrows = _add
    add_line_segments = add_mesh_simple = add_batched_glb = _add
