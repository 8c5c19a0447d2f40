"""The camera steps back for what comes, once, and leaves people where they are for what goes."""

from dataclasses import replace
from types import SimpleNamespace

from studio.engine.choices import Choices
from studio.panels.viewpoint import ALONE, RIGHT_HAND, WITH_BOTH, WITH_ONE, View, Viewpoint, view_of


def server(*clients: SimpleNamespace) -> SimpleNamespace:
    return SimpleNamespace(
        initial_camera=SimpleNamespace(position=ALONE.position, look_at=ALONE.look_at),
        get_clients=lambda: dict(enumerate(clients)),
    )


def client() -> SimpleNamespace:
    return SimpleNamespace(camera=SimpleNamespace(position=(1.0, 0.0, 0.0), look_at=(0, 0, 0)))


def test_it_steps_back_once_and_stays(lesson) -> None:
    person = client()
    page = server(person)
    viewpoint, now = Viewpoint(page), lesson["played"]
    viewpoint.draw(now)
    assert person.camera.position == (1.0, 0.0, 0.0)
    two = replace(now, compare=replace(now.compare, beside=now.world))
    viewpoint.draw(two)
    assert View(person.camera.position, person.camera.look_at) == WITH_ONE
    assert page.initial_camera.position == WITH_ONE.position
    person.camera.position = (2.0, 2.0, 2.0)
    viewpoint.draw(two)
    viewpoint.draw(now)
    assert person.camera.position == (2.0, 2.0, 2.0)
    assert page.initial_camera.position == ALONE.position


def test_more_beside_the_robot_is_seen_from_further_away(lesson) -> None:
    now = lesson["played"]
    board = replace(now, compare=replace(now.compare, field=object()))
    both = replace(now, compare=replace(now.compare, field=object(), beside=now.world))
    assert [view_of(each) for each in (now, board, both)] == [ALONE, WITH_ONE, WITH_BOTH]


def test_a_persons_right_hand_that_teaches_is_seen_beside_the_panels(lesson) -> None:
    now = lesson["played"]
    arms = {
        ("left", False): ALONE,
        ("left", True): RIGHT_HAND,  # in a mirror the person's right hand moves Baxter's left
        ("right", False): RIGHT_HAND,
        ("both", False): RIGHT_HAND,
    }
    for (arm, mirrored), view in arms.items():
        assert view_of(replace(now, choices=Choices(arm, mirrored=mirrored))) == view
    assert RIGHT_HAND.position[0] > ALONE.position[0]


def test_whoever_is_far_enough_away_stays(lesson) -> None:
    person = client()
    viewpoint, now = Viewpoint(server(person)), lesson["played"]
    person.camera.position = WITH_ONE.position  # since a board was there
    viewpoint.draw(replace(now, choices=Choices("both")))
    assert person.camera.position == WITH_ONE.position
    viewpoint.draw(now)
    person.camera.position = ALONE.position
    viewpoint.draw(replace(now, choices=Choices("both")))
    assert person.camera.position == RIGHT_HAND.position
