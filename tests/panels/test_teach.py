"""2 Teach: what is shown is what is listed, and what a person does is asked of the session."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
import viser

from studio.engine import commands
from studio.engine.collection import CollectionStatus
from studio.engine.demonstration import demonstrations_of
from studio.engine.export import Take
from studio.engine.quality import Flag
from studio.engine.recordings_folder import FolderFile
from studio.engine.snapshot import Mode
from studio.panels.cards import headline, line
from studio.panels.flags import explained, verdict
from studio.panels.recordings import broken, described, label
from studio.panels.sparkline import WIDTH
from studio.panels.teach import BY_HAND, PRESSES, UNDO, TeachPanel, removed
from tests.engine.cards_at_hand import DEFECTS, listed, takes
from tests.panels.people import use

FLAG = Flag("dropout", 1.0, 0.3, "s", "the arm was lost (<b>): record again", ((1.3, 2.3),))


@pytest.fixture
def asked() -> list[commands.Command]:
    return []


@pytest.fixture
def panel(asked) -> Iterator[TeachPanel]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield TeachPanel(server.gui, asked.append)
    server.stop()


def showing(lesson, made, state: str = "sourced"):
    return replace(lesson[state], entries=tuple(made.entries), chosen=made.index)


def rows(panel: TeachPanel) -> list[str]:
    return [row._button.label for row in panel._cards._rows if row._button.visible]


def test_every_demonstration_has_a_line_and_the_chosen_one_a_card(panel, lesson, asked) -> None:
    made = listed()
    panel.draw(showing(lesson, made))
    assert [text.split()[0] for text in rows(panel)] == ["1", "2", "3", "4"]
    card = panel._cards._card
    assert card.folder.visible
    use(panel._cards._rows[2]._button)
    assert asked == [commands.Choose(3)]
    made.take(commands.Choose(3))
    panel.draw(showing(lesson, made))
    orders = [row._button.order for row in panel._cards._rows]
    assert orders[2] < card.folder.order < orders[3]
    assert card._name.control.value == "take 3"
    made.remove(1)
    panel.draw(showing(lesson, made))
    assert [text.split()[0] for text in rows(panel)] == ["2", "3", "4"]


def test_numbers_name_what_is_asked_for_whatever_was_deleted(panel, lesson, asked) -> None:
    made = listed()
    made.remove(1)
    made.take(commands.Choose(3))
    panel.draw(showing(lesson, made))
    card = panel._cards._card
    for label_, command in (
        ("Replay", commands.PlayDemonstration(3)),
        ("Record again", commands.RecordAgain(3)),
        ("Delete", commands.Remove(3)),
    ):
        use(card._actions, label_)
        assert asked.pop() == command
    use(card._include.control, False)
    assert asked.pop() == commands.Include(3, included=False)
    use(card._name.control, "../push")
    assert asked.pop() == commands.Rename(3, "../push")
    use(card._name.control, "  ")
    assert asked == []


def test_the_two_handles_trim(panel, lesson, asked) -> None:
    made = listed()
    panel.draw(showing(lesson, made))
    slider = panel._cards._card._slider
    assert slider.value == (0.0, 100.0)
    use(slider, (20.0, 70.0))
    (command,) = asked
    whole = made.entry(1).whole.duration
    assert (command.begin, command.end) == pytest.approx((0.2 * whole, 0.7 * whole))
    made.take(command)
    panel.draw(showing(lesson, made))
    assert slider.value == (20.0, 70.0)  # not moved by rounding to samples under a hand
    assert 100.0 / whole == pytest.approx(slider.min_range)
    made.take(commands.Trim(1, 0.0, whole))  # another browser
    for _ in range(12):
        panel.draw(showing(lesson, made))
    assert slider.value == (0.0, 100.0)
    made.take(commands.Choose(2))
    made.take(commands.Trim(2, 1.0, 3.0))
    panel.draw(showing(lesson, made))
    begin, end = (share * made.entry(2).whole.duration / 100.0 for share in slider.value)
    assert (begin, end) == pytest.approx(made.entry(2).span, abs=0.02)
    assert len(asked) == 1  # what a panel shows is no person's choice


def test_nothing_is_sent_while_nothing_changes(panel, lesson) -> None:
    """Twenty demonstrations, drawn again and again, cost the page nothing."""
    made = listed(*takes() * 5)
    now = showing(lesson, made)
    panel.draw(now)
    assert sent_by(panel, [now] * 3) == []
    paused = replace(replaying(now, made.entry(1)), time=2.0)
    panel.draw(paused)
    assert sent_by(panel, [paused] * 3) == []


def sent_by(panel: TeachPanel, snapshots) -> list[object]:
    """Return the messages that drawing snapshots sends."""
    server_side = panel._cards._gui._websock_interface
    sent = []
    original = server_side.queue_message
    server_side.queue_message = lambda message: sent.append(message) or original(message)
    try:
        for now in snapshots:
            panel.draw(now)
    finally:
        server_side.queue_message = original
    return sent


def replaying(now, entry):
    """Return a snapshot with a demonstration on the timeline."""
    return replace(now, compare=replace(now.compare, replayed=entry.take))


def test_while_a_demonstration_is_replayed_its_cards_playhead_moves_alone(panel, lesson) -> None:
    made = listed()
    now = showing(lesson, made)
    panel.draw(now)
    style = panel._cards._card._playhead._style
    assert style.content == ""
    begun = replaying(now, made.entry(1))
    snapshots = [replace(begun, time=drawing / 10.0) for drawing in range(30)]
    sent = sent_by(panel, snapshots)
    assert {message.uuid for message in sent} == {style._impl.uuid}
    assert 14 <= len(sent) <= 15  # five a second
    assert max(len(message.updates["content"]) for message in sent) < 120
    whole = made.entry(1).whole.duration
    (place,) = re.findall(r"translateX\((.*?)px\)", style.content)
    assert float(place) == pytest.approx(WIDTH * 2.8 / whole, abs=0.06)
    made.take(commands.Choose(2))  # whose card shows another demonstration
    other = replace(begun, time=3.0, entries=tuple(made.entries), chosen=made.index)
    for _ in range(2):
        panel.draw(other)
    assert style.content == ""


def test_recording_automatically_and_by_hand(panel, lesson, asked) -> None:
    now = lesson["sourced"]
    panel.draw(now)
    assert panel._record.visible
    assert not panel._begin.visible
    assert not panel._repeat.visible  # the demonstrator's take has an end
    panel.draw(replace(now, source=replace(now.source, seconds=0.0)))
    assert panel._repeat.visible
    use(panel._record)
    assert asked.pop() == commands.Record(repeats=True)
    use(panel._how, BY_HAND)
    panel.draw(now)
    assert (panel._record.visible, panel._begin.visible, panel._end.visible) == (
        False,
        True,
        False,
    )
    assert panel._begin.disabled
    assert "Press Watch first" in panel._notes.content
    assert PRESSES in panel._notes.content
    panel.draw(lesson["open"])  # somebody is watched
    assert not panel._begin.disabled
    assert not panel._watch.visible
    assert "✖" not in panel._notes.content  # nothing is amiss
    use(panel._begin)
    assert asked.pop() == commands.BeginTake()
    panel.draw(replace(lesson["open"], mode=Mode.RECORDING))
    assert (panel._begin.visible, panel._end.visible) == (False, True)
    use(panel._end)
    assert asked.pop() == commands.EndTake()


def test_what_was_deleted_can_be_brought_back(panel, lesson, asked) -> None:
    start = lesson["start"]
    gone = replace(start, collection=CollectionStatus(removed="<b>push", goes_too="a.mcap"))
    panel.draw(start)
    assert not panel._undo.visible
    panel.draw(gone)
    assert panel._undo.visible
    assert "&lt;b&gt;push" in panel._removed.content
    assert "a.mcap goes too" in panel._removed.content
    assert "file stays" in removed(replace(gone, collection=CollectionStatus(removed="x")))
    use(panel._undo, UNDO)
    assert asked.pop() == commands.Restore()
    use(panel._undo, "Delete for good")
    assert asked.pop() == commands.DeleteForGood()


def test_a_line_says_all_that_matters_in_words(lesson) -> None:
    made = listed()
    entry = made.entry(1)
    assert line(entry) == "1  take 1 · 6.6 s · down"
    assert "left out" in line(replace(entry, included=False))
    assert "⚑ 1 flag" in line(replace(entry, flags=(FLAG,)))
    assert "being checked" in line(replace(entry, flags=None))
    assert len(line(entry.renamed("x" * 60))) < 45
    made.take(commands.Include(2, included=False))
    assert "3 of 4 included" in headline(showing(lesson, made))
    assert "No demonstrations yet" in headline(lesson["start"])


def test_flags_tell_value_threshold_and_place(lesson) -> None:
    made = listed()
    flagged = replace(made.entry(1), flags=(FLAG,))
    html = explained(flagged)
    assert "1.0 s, over 0.3 s; at 1.3 to 2.3 s" in html
    assert "(&lt;b&gt;): record again." in html
    trimmed = replace(flagged.trimmed(1.0, 5.0), flags=(FLAG,))
    assert "at 2.3 to 3.3 s" in explained(trimmed)  # as in the picture of the whole
    assert explained(made.entry(1)) == ""
    assert verdict(made.entry(1)) == "✔ no flags"
    still = Flag("too little motion", 2.0, 10.0, "deg", "nothing moved", ((0.0, 6.0),))
    assert "2.0°, under 10.0°" in explained(replace(flagged, flags=(still,)))
    share = Flag("limits hit", 0.2, 0.15, "of the time", "limits", ())
    assert "20 % of the time, over 15 % of the time" in explained(replace(flagged, flags=(share,)))
    block = Flag("block stands", 0.0, 1.0, "blocks down", "push further", ((6.6, 6.6),))
    assert "0 of 1 blocks down at its end" in explained(replace(flagged, flags=(block,)))
    many = replace(FLAG, places=tuple((float(n), n + 0.5) for n in range(6)))
    assert "and 3 more" in explained(replace(flagged, flags=(many,)))


def test_all_planted_defects_are_explained_by_real_flags() -> None:
    for name, plant in DEFECTS.items():
        recording = plant(1)
        (shown,) = demonstrations_of(recording, name)
        made = listed(Take(shown, recording), *takes()[1:])
        assert f"{name}</b>" in explained(made.entry(1))


def files() -> tuple[FolderFile, ...]:
    folder = Path("/recordings")
    return (
        FolderFile(folder / "demonstration-002.mcap", 9, 2e9, 13.2),
        FolderFile(folder / "demonstration-001.mcap", 9, 1e9, 12.0),
        FolderFile(folder / "<b>.mcap", 9, 1e9, None, "nothing is in it", can_open=False),
        FolderFile(folder / "monday.zip", 9, 1e9),
    )


def test_the_folder_offers_what_is_not_listed_yet(panel, lesson, asked) -> None:
    status = CollectionStatus("/recordings", files(), listed=frozenset({files()[1].path}))
    panel.draw(replace(lesson["start"], collection=status))
    folder = panel._folder
    assert [text.split(" · ")[0] for text in folder._choice.options] == [
        "demonstration-002",
        "monday",
    ]
    use(folder._open)
    assert asked.pop() == commands.OpenRecording("demonstration-002.mcap")
    use(folder._add)
    assert asked == []  # no path was typed
    folder._path.value = " ~/class "
    use(folder._add)
    assert asked.pop() == commands.AddFrom(Path("~/class"))


def test_files_are_told_by_length_date_and_what_is_wrong() -> None:
    whole, _, wrong, session = files()
    assert "13 s" in label(whole)
    assert "session" in label(session)
    assert label(whole).count(" · ") == 2
    assert "&lt;b&gt;.mcap: nothing is in it" in broken((whole, wrong))
    assert broken((whole,)) == ""
    assert "4 more" in broken((wrong,) * 9)
    status = CollectionStatus("/recordings", files(), listed=frozenset({whole.path}))
    assert "4 files, 1 on the list" in described(status, 4)
    assert "Problem" in described(replace(status, problem="no such place"), 0)


def test_what_is_being_written_is_not_called_broken(panel, lesson) -> None:
    being_written = replace(files()[0], seconds=None, problem="cut off")
    status = CollectionStatus("/recordings", (being_written, *files()[1:2]))
    now = replace(lesson["armed"], collection=status, recorded=30)
    panel.draw(now)
    assert panel._folder._problems.content == ""
    panel.draw(replace(now, recorded=0))
    assert "cut off" in panel._folder._problems.content
