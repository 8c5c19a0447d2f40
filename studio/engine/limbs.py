"""A robot's description, cut at its root into one for each limb.

Where the root stands still, limbs that hang on it do not feel each other: each is a body of its own
in the same place, and a physics engine solves several small systems instead of a large one.
"""

from collections.abc import Iterable
from copy import deepcopy
from xml.etree import ElementTree
from xml.etree.ElementTree import Element


def limbs_of(description: bytes) -> list[bytes]:
    """Return the URDF of each limb, in the order in which the root's joints stand in the file.

    Each begins with the root link. The first limb's keeps the root's shapes and looks; in the
    others the root is empty.
    """
    robot = ElementTree.fromstring(description)
    children = {_end(joint, "child") for joint in robot.iterfind("joint")}
    root = next(link for link in robot.iterfind("link") if link.get("name") not in children)
    first = [
        joint for joint in robot.iterfind("joint") if _end(joint, "parent") == root.get("name")
    ]
    limbs = [_limb(robot, root, joint) for joint in first]
    for limb in limbs[1:]:
        _empty(limb, root.get("name"))
    return [ElementTree.tostring(limb) for limb in limbs]


def _limb(robot: Element, root: Element, joint: Element) -> Element:
    """Return the robot with nothing but its root and what hangs on one of its joints."""
    joints, links = [joint], {root.get("name"), _end(joint, "child")}
    for found in joints:  # grows while it is walked
        below = [j for j in robot.iterfind("joint") if _end(j, "parent") == _end(found, "child")]
        joints += below
        links |= {_end(each, "child") for each in below}
    limb = Element("robot", robot.attrib)
    limb.extend(_copies(robot.iterfind("material")))
    limb.extend(_copies(link for link in robot.iterfind("link") if link.get("name") in links))
    limb.extend(_copies(joints))
    return limb


def _empty(limb: Element, root: str | None) -> None:
    """Take away all that the root looks like and collides as; what it weighs stays."""
    for link in limb.iterfind("link"):
        if link.get("name") == root:
            for shape in (*link.findall("visual"), *link.findall("collision")):
                link.remove(shape)


def _copies(elements: Iterable[Element]) -> list[Element]:
    return [deepcopy(element) for element in elements]


def _end(joint: Element, which: str) -> str | None:
    end = joint.find(which)
    return None if end is None else end.get("link")
