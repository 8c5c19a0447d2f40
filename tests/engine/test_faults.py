"""Faults that nobody foresaw are said in words; the traceback comes once for each."""

import logging

import pytest

from studio.engine.faults import Faults


def here(error: Exception) -> Exception:
    with pytest.raises(type(error)) as raised:
        raise error
    return raised.value


def test_a_fault_is_said_each_time_and_traced_once(caplog) -> None:
    faults, fault = Faults(), ZeroDivisionError("by\nnothing é")
    words = {faults.in_words(here(fault)) for _ in range(3)}
    (said,) = words
    assert said.startswith(r"Internal fault: ZeroDivisionError: by\nnothing \xe9; nothing")
    assert said.isascii()
    (record,) = caplog.records
    assert record.levelno == logging.ERROR
    assert record.exc_info[1] is fault
    with pytest.raises(KeyError) as elsewhere:
        {}["x"]
    assert "KeyError" in faults.in_words(elsewhere.value)
    assert len(caplog.records) == 2


@pytest.mark.parametrize("error", [ValueError(), ValueError("x" * 10_000)])
def test_words_are_never_long(error: Exception) -> None:
    assert len(Faults().in_words(error)) < 500


def test_what_is_left_is_told_as_it_is() -> None:
    words = Faults("the robot goes on").in_words(here(KeyError("x")))
    assert "; the robot goes on. The terminal" in words
    assert "holds still" not in words
