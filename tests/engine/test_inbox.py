"""The inbox keeps the order, but of a program's targets the newest wins, joint by joint."""

from studio.engine.commands import SetJointTarget, Stop, Watch
from studio.engine.inbox import Inbox
from studio.engine.snapshot import Message


def served(inbox: Inbox) -> list[object]:
    taken: list[object] = []
    inbox.serve(taken.append, lambda: Message(0, ""))
    return taken


def test_commands_come_out_in_their_order() -> None:
    inbox = Inbox()
    for command in (Watch(), Stop(), Watch()):
        inbox.put(command)
    assert served(inbox) == [Watch(), Stop(), Watch()]
    assert served(inbox) == []


def test_the_newest_target_wins_joint_by_joint() -> None:
    inbox = Inbox()
    inbox.put(SetJointTarget({"left_s0": 0.1, "left_s1": 0.2}, closed=True))
    inbox.put(SetJointTarget({"left_s0": 0.3}))
    inbox.put(SetJointTarget())
    assert served(inbox) == [SetJointTarget({"left_s0": 0.3, "left_s1": 0.2}, closed=True)]


def test_a_flood_of_targets_is_one_command() -> None:
    inbox = Inbox()
    for k in range(10_000):
        inbox.put(SetJointTarget({"left_s0": k / 1e4}))
    assert served(inbox) == [SetJointTarget({"left_s0": 0.9999})]


def test_no_target_passes_a_stop() -> None:
    inbox, first, last = Inbox(), SetJointTarget({"left_s0": 0.1}), SetJointTarget({"left_s0": 0.2})
    for command in (first, Stop(), last):
        inbox.put(command)
    assert served(inbox) == [first, Stop(), last]


def test_whoever_asked_is_told_what_was_said_of_it() -> None:
    inbox, heard, newest = Inbox(), [], [Message(0, "")]
    inbox.put(Watch(), heard.append)
    inbox.put(Stop(), heard.append)

    def take(command: object) -> None:
        if isinstance(command, Stop):
            newest.append(Message(1, "Stopped."))

    answers = inbox.serve(take, lambda: newest[-1])
    assert heard == []  # not before the tick is over
    for answer in answers:
        answer()
    assert heard == [None, Message(1, "Stopped.")]


def test_of_targets_that_became_one_all_who_asked_are_told_once() -> None:
    inbox, first, second, nothing_new = Inbox(), [], [], Message(0, "")
    tell_first, tell_second = first.append, second.append
    for k in range(100):
        inbox.put(SetJointTarget({"left_s0": k / 100}), tell_first)
    inbox.put(SetJointTarget({"left_s1": 0.1}), tell_second)
    inbox.put(SetJointTarget())
    for answer in inbox.serve(lambda _: None, lambda: nothing_new):
        answer()
    assert (first, second) == ([None], [None])
