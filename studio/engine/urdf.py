"""The URDF files of this project, read: links with their shapes, and the joints between them.

Only what our own files use: revolute, prismatic and fixed joints, boxes, cylinders, spheres and
meshes. (The tests compare with yourdfpy, which reads all of URDF, but takes 0.7 s to import.)
"""

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from studio.engine.errors import FileError
from studio.engine.skeleton import FloatArray

Color = tuple[float, float, float, float]  # red, green, blue, alpha, each 0 to 1
DEFAULT_COLOR: Color = (0.5, 0.5, 0.5, 1.0)
DEFAULT_FRICTION = 0.5  # pybullet's


@dataclass(frozen=True)
class Box:
    """A box about its own center."""

    size: tuple[float, float, float]  # [m]


@dataclass(frozen=True)
class Cylinder:
    """A cylinder along z, about its own center."""

    radius: float  # [m]
    length: float  # [m]


@dataclass(frozen=True)
class Sphere:
    """A sphere about its own center."""

    radius: float  # [m]


@dataclass(frozen=True)
class Mesh:
    """A mesh, in meters."""

    file: str  # as the URDF names it, package://... included


Shape = Box | Cylinder | Sphere | Mesh


@dataclass(frozen=True, eq=False)
class PlacedShape:
    """A shape somewhere on a link."""

    shape: Shape
    T_link_shape: FloatArray  # (4, 4)
    color: Color


@dataclass(frozen=True, eq=False)
class Link:
    """A rigid body."""

    name: str
    mass: float  # [kg]
    friction: float
    visuals: tuple[PlacedShape, ...]
    collisions: tuple[PlacedShape, ...]


@dataclass(frozen=True, eq=False)
class UrdfJoint:
    """What ties a child link to its parent; a fixed joint has limits of zero."""

    name: str
    parent: str
    child: str
    movable: bool
    T_parent_joint: FloatArray  # (4, 4)
    axis: FloatArray  # (3,) unit vector
    # Lower, upper [rad], velocity [rad/s], effort [N m]; of one that slides in m, m/s and N.
    limits: tuple[float, float, float, float]
    slides: bool = False


@dataclass(frozen=True, eq=False)
class Urdf:
    """A whole file, in its own order."""

    links: tuple[Link, ...]
    joints: tuple[UrdfJoint, ...]


def read_urdf(path: Path) -> Urdf:
    """Read one of the project's URDF files.

    Raises
    ------
    FileError
        Where the file is missing, is not XML, or holds something that is not read here.
    """
    return urdf_of(parse_xml(path), path)


def urdf_of(root: Element, path: Path) -> Urdf:
    """Read a description that has been parsed already; ``path`` names it in errors.

    Raises
    ------
    FileError
        Where it holds something that is not read here.
    """
    try:
        colors = {m.attrib["name"]: _color(m) for m in root.findall("material")}
        links = tuple(_link(element, colors) for element in root.findall("link"))
        joints = tuple(_joint(element) for element in root.findall("joint"))
    except (KeyError, ValueError) as error:
        raise FileError(f"{path}: not a URDF file of the studio's ({error}); reinstall") from error
    return Urdf(links, joints)


def parse_xml(path: Path) -> Element:
    """Return the root element of an XML file; raise FileError where there is none."""
    try:
        return ElementTree.parse(path).getroot()
    except (OSError, ElementTree.ParseError) as error:
        raise FileError(f"{path}: cannot be read as XML ({error}); reinstall") from error


def transform(xyz: FloatArray, rpy: FloatArray) -> FloatArray:
    """Return the (4, 4) transform of URDF's ``origin``: first roll, then pitch, then yaw."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    T = np.eye(4)
    T[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    T[:3, 3] = xyz
    return T


def _link(element: Element, colors: dict[str, Color]) -> Link:
    mass = element.find("inertial/mass")
    friction = element.find("contact/lateral_friction")
    return Link(
        name=element.attrib["name"],
        mass=0.0 if mass is None else float(mass.attrib["value"]),
        friction=DEFAULT_FRICTION if friction is None else float(friction.attrib["value"]),
        visuals=tuple(_placed(e, colors) for e in element.findall("visual")),
        collisions=tuple(_placed(e, colors) for e in element.findall("collision")),
    )


def _placed(element: Element, colors: dict[str, Color]) -> PlacedShape:
    material = element.find("material")
    color = DEFAULT_COLOR if material is None else colors[material.attrib["name"]]
    return PlacedShape(_shape(element), _origin(element), color)


def _shape(element: Element) -> Shape:
    geometry = element.find("geometry")
    (shape,) = () if geometry is None else tuple(geometry)
    match shape.tag:
        case "box":
            x, y, z = _numbers(shape.attrib["size"]).tolist()
            return Box((x, y, z))
        case "cylinder":
            return Cylinder(float(shape.attrib["radius"]), float(shape.attrib["length"]))
        case "sphere":
            return Sphere(float(shape.attrib["radius"]))
        case "mesh":
            return Mesh(shape.attrib["filename"])
    raise ValueError(f"the unknown shape <{shape.tag}>")


def _joint(element: Element) -> UrdfJoint:
    kind = element.attrib["type"]
    if kind not in ("revolute", "prismatic", "fixed"):
        raise ValueError(f"a {kind} joint, not a revolute, prismatic or fixed one")
    limit, axis = element.find("limit"), element.find("axis")
    limits = {} if limit is None else limit.attrib
    lower, upper, velocity, effort = (
        float(limits.get(name, 0.0)) for name in ("lower", "upper", "velocity", "effort")
    )
    return UrdfJoint(
        name=element.attrib["name"],
        parent=_named(element, "parent"),
        child=_named(element, "child"),
        movable=kind != "fixed",
        T_parent_joint=_origin(element),
        axis=_numbers("1 0 0" if axis is None else axis.attrib["xyz"]),
        limits=(lower, upper, velocity, effort),
        slides=kind == "prismatic",
    )


def _named(element: Element, tag: str) -> str:
    found = element.find(tag)
    if found is None:
        raise ValueError(f"a joint without <{tag}>")
    return found.attrib["link"]


def _origin(element: Element) -> FloatArray:
    origin = element.find("origin")
    attributes = {} if origin is None else origin.attrib
    return transform(*(_numbers(attributes.get(name, "0 0 0")) for name in ("xyz", "rpy")))


def _color(element: Element) -> Color:
    color = element.find("color")
    if color is None:
        raise ValueError("a material without <color>")
    red, green, blue, alpha = _numbers(color.attrib["rgba"]).tolist()
    return (red, green, blue, alpha)


def _numbers(text: str) -> FloatArray:
    return np.array([float(word) for word in text.split()])
