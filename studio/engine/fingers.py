"""The electric grippers' fingers: two to a hand, mounted on the robot only where they are wanted.

Without them the robot is what it was, to the last bit. Both fingers of a hand are told the same
position, and meet what they hold each on its own.
"""

from copy import deepcopy
from xml.etree.ElementTree import Element

from studio.engine.resources import resource_root
from studio.engine.skeleton import SIDES, Side
from studio.engine.urdf import parse_xml

FINGERS = ("finger_1", "finger_2")  # of one hand; each is a link, and the joint that carries it
FINGER_JOINTS: tuple[str, ...] = tuple(f"{side}_{finger}" for side in SIDES for finger in FINGERS)
OPEN = 0.020833  # [m] that each finger is out, see urdf/fingers.urdf
CLOSED = 0.0


def fingers_of(side: Side, closed: bool) -> dict[str, float]:
    """Return where the joints of a hand's fingers belong [m]."""
    return dict.fromkeys([f"{side}_{finger}" for finger in FINGERS], CLOSED if closed else OPEN)


def mount_fingers(robot: Element) -> None:
    """Put fingers on both hands of a robot's description, in place.

    Raises
    ------
    FileError
        Where urdf/fingers.urdf cannot be used.
    """
    fingers = parse_xml(resource_root() / "urdf" / "fingers.urdf")
    known = {material.get("name") for material in robot.findall("material")}
    robot.extend(each for each in fingers.findall("material") if each.get("name") not in known)
    for side in SIDES:
        for part in (*fingers.findall("link"), *fingers.findall("joint")):
            if part.get("name") != "hand":
                robot.append(_named_for(part, side))


def _named_for(part: Element, side: Side) -> Element:
    """Return a link or a joint as a copy for one hand: ``left_finger_1``."""
    copy = deepcopy(part)
    copy.set("name", f"{side}_{part.get('name')}")
    for end in (*copy.findall("parent"), *copy.findall("child")):
        end.set("link", f"{side}_{end.get('link')}")
    return copy
