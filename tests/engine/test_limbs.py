from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import pytest

from studio.engine.limbs import limbs_of
from studio.engine.robot import urdf_with_meshes, urdf_without_visuals


def names(tree: Element, tag: str) -> list[str]:
    return [element.get("name", "") for element in tree.iterfind(tag)]


@pytest.mark.parametrize("fingers", [False, True])
def test_limbs_together_are_the_robot(fingers: bool) -> None:
    whole = ElementTree.fromstring(urdf_without_visuals(fingers))
    limbs = limbs_of(urdf_without_visuals(fingers))
    head, left, right = (ElementTree.fromstring(limb) for limb in limbs)
    assert names(head, "link") == ["base", "head"]
    assert all(name.startswith("left_") for name in names(left, "link")[1:])
    assert all(name.startswith("right_") for name in names(right, "link")[1:])
    for tag in ("joint", "link"):
        found = {name for limb in (head, left, right) for name in names(limb, tag)}
        assert found == set(names(whole, tag))
    for limb in (head, left, right):
        for tag in ("joint", "link"):
            for element in limb.iterfind(tag):
                same = next(e for e in whole.iterfind(tag) if e.get("name") == element.get("name"))
                if element.get("name") != "base":
                    assert ElementTree.tostring(element) == ElementTree.tostring(same)


def test_only_the_first_limb_has_what_the_root_looks_like_and_collides_as() -> None:
    for number, limb in enumerate(limbs_of(urdf_with_meshes())):
        root = ElementTree.fromstring(limb).find("link[@name='base']")
        assert root is not None
        assert root.find("inertial") is not None
        assert (root.find("collision") is not None) == (number == 0)
        assert (root.find("visual") is not None) == (number == 0)
