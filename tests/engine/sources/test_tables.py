import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import StudioError
from studio.engine.sources import tables
from studio.engine.sources.content import content_of
from studio.engine.sources.tables import recognizes


def read(text):
    return tables.read(content_of("table", text.encode()).lines())


def positions(parsed):
    return np.array([body.positions for frame in parsed.frames for body in frame.bodies])


@pytest.mark.parametrize("columns", [75, 100, 101, 175])
@pytest.mark.parametrize("separator", [",", ";", "\t", " ", ", ", "  "])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("trailing", [False, True])
@pytest.mark.parametrize("header", ["", "Joint 1 x,Joint 1 y\n# recorded in 2017, at 30 Hz\n\n"])
def test_every_dialect_says_the_same(made, columns, separator, end, trailing, header):
    text = made.table_text(made.table_rows(columns), separator, trailing * separator + end)
    parsed = read(header + text + end + "  " + end)
    assert recognizes(header + text)
    assert parsed.format == f"table {columns}"
    assert (positions(parsed) == [made.standing(frame) for frame in range(4)]).all()
    assert not parsed.has_hand_states
    assert parsed.has_tracking == (columns in (100, 101))
    assert parsed.has_stamps == (columns == 101)


def test_stamps_count_from_the_first_line_without_loss(made):
    rows = made.table_rows(101)
    for row, ticks in zip(rows, (0, 0, 1, 10**7), strict=True):
        row[0] = 10**18 + 1 + ticks  # a float64 would know it to 128 only
    assert [frame.time for frame in read(made.table_text(rows)).frames] == [0.0, 0.0, 1e-7, 1.0]


def test_stamps_may_be_written_as_floats(made):
    rows = made.table_rows(101, frames=2)
    rows[0][0], rows[1][0] = "8.5e9", "8500333333.5"
    assert [frame.time for frame in read(made.table_text(rows)).frames] == [0.0, 0.03333335]


def test_without_stamps_thirty_frames_a_second_pass(made):
    parsed = read(made.table_text(made.table_rows(75)))
    assert [frame.time for frame in parsed.frames] == [0, 1 / 30, 2 / 30, 3 / 30]


def test_a_header_of_column_numbers_is_no_frame(made):
    rows = [list(range(75)), *made.table_rows(75)]
    assert len(read(made.table_text(rows)).frames) == 4


@pytest.mark.parametrize("marks", [[0, 1, 2], [2], [0], [1]])
def test_whole_marks_are_states(made, marks):
    rows = made.table_rows(100, frames=3)
    for frame, row in enumerate(rows):
        row[3::4] = [marks[(frame + joint) % len(marks)] for joint in range(25)]
    for row, frame in zip(rows, read(made.table_text(rows)).frames, strict=True):
        assert frame.bodies[0].tracking.tolist() == row[3::4]


def test_fractions_are_confidences(made):
    rows = made.table_rows(100, frames=1)
    rows[0][3::4] = [0.0, 1e-9, 0.49, 0.5, 1.0] * 5
    assert read(made.table_text(rows)).frames[0].bodies[0].tracking.tolist() == [0, 1, 1, 2, 2] * 5


@pytest.mark.parametrize("mark", [3, -1, 1.5, 2.5])
def test_a_mark_that_is_neither_is_an_error(made, mark):
    rows = made.table_rows(101)
    rows[2][4 * 6 + 4] = mark
    with pytest.raises(StudioError, match=rf"line 3, joint 6 \(wrist_left\).*found {mark}"):
        read(made.table_text(rows))


@pytest.mark.parametrize("value", ["nan", "inf", "-Infinity", "1e999", "x", "", "1_0", "0x1", "١"])
def test_what_is_no_finite_number_is_named_with_its_place(made, value):
    rows = made.table_rows(175)
    for line in (0, 2):
        broken = [list(row) for row in rows]
        broken[line][9] = value
        with pytest.raises(StudioError, match=f"line {line + 2}, column 10: expected a finite"):
            read("x,y,z\n" + made.table_text(broken))


@pytest.mark.parametrize("count", [2, 60, 74, 76, 99, 102, 174, 176])
def test_other_widths_are_refused_with_those_that_are_read(count):
    text = ",".join(["0.5"] * count) + "\n"
    assert recognizes(text)
    with pytest.raises(StudioError, match=f"line 1: expected 75, 100, .* columns, found {count}"):
        read(text)


def test_an_endless_line_is_not_taken_apart():
    with pytest.raises(StudioError, match="columns, found more than 1000"):
        read("1 " * 100_000)


def test_a_line_of_another_width_is_named(made):
    rows = made.table_rows(100)
    rows[2].pop()
    with pytest.raises(StudioError, match="line 5: expected 100 columns as in line 3, found 99"):
        read("\nheader\n" + made.table_text(rows))


def test_stamps_that_run_backwards_are_named(made):
    rows = made.table_rows(101)
    rows[2][0] = rows[1][0] - 1
    with pytest.raises(StudioError, match="line 3, column 1: the time goes backwards"):
        read(made.table_text(rows))


@pytest.mark.parametrize("stamp", ["9" * 300, "1e300", "9" * 30])
def test_absurd_stamps_are_refused(made, stamp):
    rows = made.table_rows(101)
    rows[1][0] = stamp
    with pytest.raises(StudioError, match="expected a time in seconds"):
        read(made.table_text(rows))


@pytest.mark.parametrize("text", ["", "words only\n" * 30, "1\n2\n3\n", "{}", "\0\0\0"])
def test_what_has_no_rows_of_numbers_is_no_table(text):
    assert not recognizes(text)


@settings(deadline=None, derandomize=True, max_examples=40)
@given(
    st.lists(
        st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=75, max_size=75),
        min_size=1,
        max_size=3,
    )
)
def test_positions_are_read_to_the_last_bit(rows):
    text = "\n".join(" ".join(map(repr, row)) for row in rows)
    assert (positions(read(text)) == np.reshape(rows, (-1, 25, 3))).all()
