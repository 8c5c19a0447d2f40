import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.svg import MOST_TICKS, Box, Chart, Line, legend, log_ticks, ticks

X = np.linspace(0.0, 10.0, 5)


def points_of(svg):
    (points,) = re.findall(r'polyline points="([^"]*)"', svg)
    return np.array([[float(v) for v in pair.split(",")] for pair in points.split()])


def test_a_chart_is_well_formed_and_names_its_parts():
    line = Line(X, X**2, "#123456", "4 2", marked=True)
    svg = Chart("a < b", "time & more", "y", (line,)).svg()
    root = ET.fromstring(svg)
    assert root.get("aria-label") == "a < b"
    assert len(root.findall("circle")) == 5
    assert "time &amp; more" in svg


def test_larger_is_higher_and_later_is_further_right_and_all_stays_inside():
    for log in (False, True):
        svg = Chart("t", "x", "y", (Line(X, 10.0**X, "#000"),), size=(300, 200), log=log).svg()
        x, y = points_of(svg).T
        assert (np.diff(x) > 0.0).all()
        assert (np.diff(y) <= 0.0).all()
        assert x.min() >= 0.0
        assert x.max() <= 300.0
        assert y.min() >= 0.0
        assert y.max() <= 200.0
        if log:  # powers lie evenly
            np.testing.assert_allclose(np.diff(y), np.diff(y)[0], atol=0.15)


def test_equal_units_are_equal():
    circle = np.linspace(0.0, 2.0 * np.pi, 60)
    line = Line(np.cos(circle), np.sin(circle), "#000")
    box = Box((-0.5, 0.5), (-0.5, 0.5), "b", "#eee")
    x, y = points_of(Chart("t", "x", "y", (line,), (box,), (500, 200), equal=True).svg()).T
    assert np.ptp(x) == pytest.approx(np.ptp(y), abs=0.5)


def test_both_axes_may_be_logarithmic():
    powers = 10.0 ** np.arange(4.0)
    x, y = points_of(
        Chart("t", "x", "y", (Line(powers, powers, "#000"),), log=True, log_x=True).svg()
    ).T
    np.testing.assert_allclose(np.diff(x), np.diff(x)[0], atol=0.15)
    np.testing.assert_allclose(np.diff(y), np.diff(y)[0], atol=0.15)


@settings(deadline=None, derandomize=True)
@given(low=st.floats(-1e6, 1e6), width=st.floats(1e-3, 1e6))
def test_ticks_are_few_round_and_inside(low, width):
    found = ticks(low, low + width)
    assert 1 <= len(found) <= MOST_TICKS + 2
    room = 1e-6 * width + 1e-9 * abs(low)
    assert all(low - room <= tick <= low + width + room for tick in found)


def test_log_ticks_are_decades_where_there_are_many():
    np.testing.assert_allclose(log_ticks(-2.0, 2.0), [0.01, 0.1, 1.0, 10.0, 100.0])
    np.testing.assert_allclose(
        log_ticks(0.0, np.log10(300.0)), [1.0, 3.0, 10.0, 30.0, 100.0, 300.0]
    )
    np.testing.assert_allclose(log_ticks(0.0, 1.0), [1.0, 2.0, 5.0, 10.0])
    assert len(log_ticks(0.0, 0.01)) >= 3


def test_flat_curves_have_a_chart_too():
    ET.fromstring(Chart("t", "x", "y", (Line(X, np.ones(5), "#000"),)).svg())
    assert "a &amp; b" in legend([("a & b", Line(X, X, "#000"))])
