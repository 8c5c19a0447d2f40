"""The step of learning: what is drawn is what is known, and no answer comes before a guess."""

import contextlib
import html
import io
import math
import re
import socket
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
import viser

from studio.engine import commands
from studio.engine.commands import Command
from studio.engine.curves import COUNTS, BlockPoint, Trial, block_point_of, error_point
from studio.engine.export import Job, tables
from studio.engine.export.equation import Equation
from studio.engine.export.equations import equations_of
from studio.engine.export.material import Material
from studio.engine.findings import Curve, Tried
from studio.engine.learning_status import LearningStatus, Underway
from studio.engine.teaching import LEARNERS, LearnerName, LearnerSettings, learn
from studio.panels.basis import drawn
from studio.panels.error_chart import across, error_chart, readout, strip
from studio.panels.guessing import question, score
from studio.panels.learn import LearnPanel, why_not_suggest
from studio.panels.network_choice import LEARNER_LABELS, NetworkChoice, place_of
from studio.panels.numbers import learned, of_chosen
from tests.engine.export.materials import done, listed
from tests.engine.sweeps import samples

SIX = LearnerSettings("rbf", 6)
POINTS = tuple(error_point(samples(2), LearnerSettings("rbf", n)) for n in (2, 6, 15))


def status(**changes: object) -> LearningStatus:
    plain = LearningStatus(SIX, None, Curve("rbf", POINTS), False, (), {})
    return replace(plain, **changes)


def tried(neurons: int, down: bool, guess: bool | None) -> Tried:
    return Tried("rbf", BlockPoint(neurons, down, 0.0123, 0.0304, done=down), guess)


# The curve and its strip


def svgs(page: str) -> list[ET.Element]:
    return [ET.fromstring(found) for found in re.findall(r"<svg.*?</svg>", page, re.DOTALL)]


def test_the_curve_shows_what_is_known_beside_the_paper_and_the_floor() -> None:
    page = error_chart(status())
    chart, blocks, *_ = svgs(page)
    for name in ("the paper's Table I", "floor", "held out", "on what was taught"):
        assert html.escape(name) in page
    circles = chart.findall("circle")
    assert len(circles) == 6 + len(POINTS) + 1  # the table's, the curve's, the chosen one
    assert blocks.get("aria-label") == "which blocks fell"


def test_the_chosen_number_is_marked_on_curve_and_strip_alike() -> None:
    for neurons in (1, 6, 13, 300):
        chart, blocks, *_ = svgs(error_chart(status(chosen=LearnerSettings("rbf", neurons))))
        wanted = across(neurons)
        (mark,) = (
            line.get("points")
            for line in chart.findall("polyline")
            if line.get("stroke-dasharray") == "4 3"
        )
        xs = {float(pair.split(",")[0]) for pair in mark.split()}
        assert xs == {float(f"{wanted:.1f}")}
        assert blocks.find("path").get("d").startswith(f"M{wanted:.1f} 0")


def test_before_anything_is_known_there_is_a_page_too() -> None:
    empty = status(curve=Curve("rbf"))
    assert "no guess yet" in error_chart(empty)
    assert "not known yet" in readout(empty)
    assert "held out" not in error_chart(empty)


def test_the_readout_tells_the_errors_of_the_chosen_number() -> None:
    shown = readout(status())
    assert "<b>6 neurons</b>" in shown
    assert f"MSE {POINTS[1].mse:.3g} rad²" in shown
    assert f"{POINTS[1].floor_ratio:.4g} × floor" in shown
    assert "not on the curve yet" in readout(status(chosen=LearnerSettings("rbf", 7)))
    assert "<b>1 neuron</b>" in readout(status(chosen=LearnerSettings("rbf", 1)))


def test_a_block_that_fell_lies_and_one_that_did_not_stands() -> None:
    (drawing,) = svgs(
        strip([tried(2, False, True), tried(9, True, True), tried(10, True, None)], 6)
    )
    boxes = [group.find("rect") for group in drawing.findall("g")]
    shapes = [float(box.get("width")) > float(box.get("height")) for box in boxes]
    assert shapes == [False, True, True]
    ground = {float(box.get("y")) + float(box.get("height")) for box in boxes}
    assert len(ground) == 1
    assert [group.find("text").text for group in drawing.findall("g")] == ["✗", "✓", None]


# Failing on purpose


def test_the_answer_stays_hidden_until_somebody_guesses() -> None:
    asked = question(status(), "")
    assert "At <b>6 neurons</b>: will the block fall?" in asked
    for telling in ("the block falls", "stays up", "mm off"):
        assert telling not in asked
        assert telling not in error_chart(status()).replace("▮ stays up", "")
    answered = question(status(tried=(tried(6, True, False),)), "")
    assert "the block falls" in answered
    assert "You said: it stays up ✗" in answered
    assert "30 mm off" in answered


def test_how_long_a_trial_takes_is_said_of_each_learner() -> None:
    assert "in about a second." in question(status(), "")
    field = question(status(chosen=LearnerSettings("field", 6)), "")
    assert "takes a stable field one to three seconds, or more with many demonstrations." in field


def test_another_networks_answer_is_none_of_this_one() -> None:
    other = replace(tried(6, True, True), learner="newrb")
    assert "will the block fall?" in question(status(tried=(other,)), "")


def test_the_score_counts_guesses_and_opens_all_after_three() -> None:
    assert "After 3" in score(status())
    one = status(tried=(tried(2, False, False),))
    assert "1 of 1 guess right" in score(one)
    assert "Guess 2 more" in score(one)
    known = (tried(2, False, False), tried(4, True, False), tried(6, True, True))
    three = score(status(tried=(*known, tried(9, True, None))))
    assert "2 of 3 guesses right" in three
    assert "from 4 neurons on the block falls" in three
    floor = status().curve.floor
    assert f"{0.0123 / floor:.3g} × the floor" in three


def test_a_refusal_is_said_beside_the_question() -> None:
    assert "record one in 2 Teach" in question(status(), "Nothing: record one in 2 Teach.")


# Numbers and their equations


@cache
def taught(learner: LearnerName, neurons: int, count: int) -> Material:
    """Return what was learned, and not done yet."""
    material = listed(count)
    settings = LearnerSettings(learner, neurons)
    return replace(material, lesson=learn(material.taught, settings))


def printed(program: str) -> float:
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(program, "program", "exec"), {})
    return float(said.getvalue())


@pytest.mark.parametrize("case", [("rbf", 20, 2), ("newrb", 20, 1)])
def test_each_number_opens_an_equation_whose_program_prints_it(case, tmp_path: Path) -> None:
    """From the page's own HTML to the number, by way of the exported tables."""
    material = taught(*case)
    tables.write(material, Job(tmp_path))
    equations = equations_of(material.lesson)
    page = learned(material.lesson, equations)
    buttons = re.findall(r'popovertarget="([^"]+)"[^>]*>([^<]+)</button>', page)
    cards = dict(
        re.findall(r'<div popover id="([^"]+)"[^>]*>(.*?</details>)</div>', page, re.DOTALL)
    )
    assert {target for target, _ in buttons} == set(cards)
    assert len(cards) == len(buttons) >= 7
    by_name = {html.escape(equation.name): equation for equation in equations.values()}
    for target, shown in buttons:
        (name,) = re.findall(r"<b>(.*?)</b>", cards[target])
        (program,) = re.findall(r"<pre[^>]*>(.*?)</pre>", cards[target], re.DOTALL)
        equation = by_name[name]
        assert html.escape(equation.formula) in cards[target]
        assert html.escape(equation.filled) in cards[target]
        program = html.unescape(program).replace("folder = '.'", f"folder = {str(tmp_path)!r}")
        found = printed(program)
        assert found == pytest.approx(equation.value, rel=1e-9, abs=1e-9), name
        number = math.inf if shown.startswith("&gt;") else float(shown)
        assert number == pytest.approx(equation.value, rel=0.06, abs=5e-3), name


def opened(page: str) -> dict[str, str]:
    """Return the numbers that open something by the names of the equations."""
    buttons = re.findall(r'popovertarget="([^"]+)"[^>]*>([^<]+)</button>', page)
    names = dict(re.findall(r'<div popover id="([^"]+)"[^>]*><b>(.*?)</b>', page))
    assert {target for target, _ in buttons} == set(names)
    return {html.unescape(names[target]): shown for target, shown in buttons}


@cache
def tried_out() -> tuple[Trial, dict[str, Equation], LearningStatus]:
    """Return a network after a guess, as a session has it."""
    made = done("rbf", 6, 2)
    equations = equations_of(made.lesson, made.reproduction)
    point = block_point_of(made.lesson, made.reproduction)
    errors = error_point(made.taught, SIX)
    known = (Tried("rbf", point, True),)
    learning = status(curve=Curve("rbf", (errors,)), tried=known, equations=equations)
    return Trial(made.lesson, made.reproduction), equations, learning


def test_the_guesss_answer_opens_the_equations_of_its_network() -> None:
    _, equations, learning = tried_out()
    found = opened(question(learning, "", equations=equations))
    wanted = {"mse": ".3g", "ratio": ".3g", "hand mean": ".0f"}
    assert found == {
        equations[key].name: format(equations[key].value, form) for key, form in wanted.items()
    }
    assert "popover" not in question(learning, "")


def test_the_readout_opens_the_equations_of_its_network() -> None:
    _, equations, learning = tried_out()
    found = opened(readout(learning, equations))
    wanted = {"mse": ".3g", "ratio": ".4g", "held-out": ".3g"}
    assert found == {
        equations[key].name: format(equations[key].value, form) for key, form in wanted.items()
    }
    assert "popover" not in readout(learning)


def test_another_networks_numbers_open_nothing(lesson) -> None:
    trial, equations, learning = tried_out()
    now = replace(lesson["trained"], learning=learning, lesson=trial.lesson)
    assert of_chosen(now) is equations
    assert of_chosen(replace(now, lesson=None)) == {}
    elsewhere = replace(learning, chosen=LearnerSettings("rbf", 7))
    assert of_chosen(replace(now, learning=elsewhere)) == {}
    # Of as many neurons, but from other demonstrations: its numbers are others.
    (point,) = learning.curve.points
    (guessed,) = learning.tried
    other = replace(
        learning,
        curve=Curve("rbf", (replace(point, mse=2.0 * point.mse, held_out=2.0 * point.held_out),)),
        tried=(replace(guessed, point=replace(guessed.point, mse=0.5, hand_error=0.7)),),
    )
    assert opened(question(other, "", equations=equations)) == {}
    assert list(opened(readout(other, equations))) == [equations["ratio"].name]


def test_without_equations_there_are_numbers_all_the_same() -> None:
    lesson = taught("rbf", 8, 2).lesson
    page = learned(lesson, {})
    assert "popover" not in page
    assert "come in a moment" in page
    assert f"{lesson.mse[0]:.2e}" in page


@pytest.mark.parametrize("learner", LEARNERS)
def test_the_gaussians_of_each_learner_or_why_there_are_none(learner) -> None:
    assert learner in LEARNER_LABELS
    if learner == "field":
        return  # takes seconds; as the plain field it is
    page = drawn(taught(learner, 5, 2).lesson, 1)
    if learner == "plain-field":
        assert "no Gaussians over time" in page
    else:
        chart, *_ = svgs(page)
        assert len(chart.findall("polyline")) == 5 + 1
        assert "their sum" in page


# The panel itself


@pytest.fixture
def gui() -> Iterator[viser.GuiApi]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer("127.0.0.1", port, verbose=False)
        yield server.gui
        server.stop()


def test_slider_and_number_say_the_same(gui: viser.GuiApi) -> None:
    posted: list[Command] = []
    choice = NetworkChoice(gui, posted.append)
    choice._slider.value = COUNTS.index(12)
    choice._slid()
    assert choice._number.value == 12
    choice._number.value = 140
    choice._send(replace(choice.settings, neurons=choice._typed()))
    assert COUNTS[choice._slider.value] == 142
    wanted = [LearnerSettings("rbf", 12), LearnerSettings("rbf", 140)]
    assert posted == [commands.ChooseLearner(each) for each in wanted]


def test_what_is_being_dragged_is_not_pulled_back(gui: viser.GuiApi) -> None:
    choice = NetworkChoice(gui, lambda _: None)
    for count in (12, 9):
        choice._slider.value = COUNTS.index(count)
        choice._slid()
        choice.draw(LearnerSettings("rbf", 50))  # the session has not heard of it yet
    assert choice._number.value == 9
    choice.draw(LearnerSettings("rbf", 9))
    choice.draw(LearnerSettings("newrb", 3))  # another browser's
    assert (choice._number.value, COUNTS[choice._slider.value]) == (3, 3)
    assert choice._learner.value == LEARNER_LABELS["newrb"]


def test_what_never_came_through_is_taken_back(gui: viser.GuiApi) -> None:
    choice = NetworkChoice(gui, lambda _: None)
    choice.choose(LearnerSettings("rbf", 7))
    for _ in range(12):
        choice.draw(LearnerSettings("rbf", 50))
    assert choice._number.value == 50


def test_the_slider_is_logarithmic() -> None:
    for place, count in enumerate(COUNTS):
        assert place_of(count) == place
    assert COUNTS[place_of(11)] in (10, 12)
    assert COUNTS[place_of(220)] in (200, 250)


def test_every_state_is_drawn_with_its_reasons(gui: viser.GuiApi, lesson) -> None:
    posted: list[Command] = []
    panel = LearnPanel(gui, posted.append)
    for now in lesson.values():
        panel.draw(now)
    panel.draw(lesson["start"])
    assert panel._train.disabled
    assert panel._suggest.disabled
    assert "record one in 2 Teach" in panel._ready.content
    busy = replace(lesson["trained"].learning, underway=Underway("training 9 neurons", 0.25))
    panel.draw(replace(lesson["trained"], learning=busy))
    assert "Training 9 neurons, 25 %" in panel._waiting._words.content
    assert panel._waiting._cancel.visible
    assert panel._train.disabled
    assert "Wait, or press Cancel" in panel._ready.content
    panel.draw(lesson["trained"])
    assert not panel._waiting._cancel.visible
    assert not panel._train.disabled


def test_a_suggestion_is_taken_or_says_what_it_lacks(gui: viser.GuiApi, lesson) -> None:
    now = lesson["taught twice"]
    assert "waits for a quiet moment: 3 of 27" in why_not_suggest(replace(now, learning=status()))
    drawing = replace(now, learning=status(is_drawing=True))
    assert "is being drawn: 3 of 27" in why_not_suggest(drawing)
    assert "two demonstrations" in why_not_suggest(lesson["recorded"])
    stopped = status(curve=Curve("rbf", POINTS, "stopped"))
    assert "not complete: stopped" in why_not_suggest(replace(now, learning=stopped))
    whole = tuple(replace(POINTS[0], neurons=n, mse=1.0 / n, held_out=1.0 / n) for n in COUNTS)
    ready = replace(now, learning=status(curve=Curve("rbf", whole)))
    assert why_not_suggest(ready) == ""
    posted: list[Command] = []
    panel = LearnPanel(gui, posted.append)
    panel.draw(ready)
    assert "Suggested: 300 neurons" in panel._why.content
    panel._take_suggestion()
    assert posted == [commands.ChooseLearner(LearnerSettings("rbf", 300))]
